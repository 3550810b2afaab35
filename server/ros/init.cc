#include "server/ros/init.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <spdlog/fmt/fmt.h>
#include <xmlrpcpp/XmlRpcUtil.h>

#include <cstdlib>
#include <mutex>
#include <optional>

#include "core/system/check.h"
#include "core/system/errors.h"
#include "server/ros/bridge.h"
#include "server/ros/master_client.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

// roscpp has one node per process, so its command line arguments belong to the process, too.
std::map<std::string, std::string>& MutablePrivateArguments() {
  static std::map<std::string, std::string> arguments;
  return arguments;
}

// XmlRpc++ prints a line for each refused connection; an unreachable master is not worth a line
// here.
class SilentErrors : public XmlRpc::XmlRpcErrorHandler {
 public:
  void error(const char*) override {}
};

void SilenceXmlRpc() {
  static SilentErrors silent;
  XmlRpc::XmlRpcErrorHandler::setErrorHandler(&silent);
}

// Otherwise roscpp would send `_name:=value` to the master on starting, and wait for one without
// limit.
void TakePrivateArguments(int& argc, char** argv) {
  int kept = 0;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t sign = argument.find(":=");
    const bool is_private =
        i > 0 && sign != std::string::npos && sign > 1 && argument[0] == '_' && argument[1] != '_';
    if (is_private) {
      MutablePrivateArguments()[argument.substr(1, sign - 1)] = argument.substr(sign + 2);
    } else {
      argv[kept++] = argv[i];
    }
  }
  argc = kept;
}

// roscpp aborts the process if it cannot parse an address.
void CheckMasterUri(int argc, char** argv) {
  std::string uri = ros::getROSArg(argc, argv, "__master");
  const char* from_environment = std::getenv("ROS_MASTER_URI");
  if (uri.empty() && from_environment != nullptr) uri = from_environment;
  std::string host;
  std::uint32_t port = 0;
  const bool is_set = from_environment != nullptr || !uri.empty();
  if (is_set && (!ros::network::splitURI(uri, host, port) || port == 0 || port > 65535)) {
    throw UsageError(fmt::format("ROS_MASTER_URI={}: expected http://<host>:<port>", uri));
  }
}

std::optional<std::string> AsText(XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean: return static_cast<bool>(value) ? "true" : "false";
    case XmlRpcValue::TypeInt: return fmt::format("{}", static_cast<int>(value));
    case XmlRpcValue::TypeDouble: return fmt::format("{}", static_cast<double>(value));
    case XmlRpcValue::TypeString: return static_cast<std::string>(value);
    default: return std::nullopt;
  }
}

// Fetches all parameters at the first call: a master that does not answer then costs one timeout
// and not one per option.
XmlRpcValue FetchPrivateParameters() {
  XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  const MasterReply reply = MasterClient().Call("getParam", arguments);
  return reply.code == MasterReply::Code::kGood ? reply.value : XmlRpcValue();
}

}  // namespace

const std::map<std::string, std::string>& PrivateArguments() { return MutablePrivateArguments(); }

bool BuiltWithRos() { return true; }

void InitRos(int& argc, char** argv, const std::string& default_name) {
  TakePrivateArguments(argc, argv);
  CheckMasterUri(argc, argv);
  SilenceXmlRpc();
  try {
    // Kinescope handles Ctrl-C itself, and logs to the terminal and not to /rosout.
    ros::init(argc, argv, default_name,
              ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  } catch (const ros::Exception& error) {
    throw UsageError(fmt::format("ROS does not accept these names: {}", error.what()));
  }
}

std::string MasterUri() {
  KINESCOPE_CHECK(ros::isInitialized());
  return ros::master::getURI();
}

bool MasterIsReachable() {
  KINESCOPE_CHECK(ros::isInitialized());
  return MasterClient().Call("getPid", XmlRpcValue()).code == MasterReply::Code::kGood;
}

void LeaveRos() {
  if (!ros::isStarted()) return;
  // roscpp unregisters topic by topic without a time limit: a master on a machine that was switched
  // off would delay the exit for minutes. So its address is removed first.
  if (!MasterIsReachable()) const_cast<std::string&>(ros::master::getHost()).clear();
  ros::shutdown();
}

std::optional<std::string> PrivateParameter(const std::string& name) {
  KINESCOPE_CHECK(ros::isInitialized());
  const auto argument = PrivateArguments().find(name);
  if (argument != PrivateArguments().end()) return argument->second;
  static std::mutex mutex;
  static std::optional<XmlRpcValue> parameters;  // guarded by mutex
  const std::lock_guard<std::mutex> lock(mutex);
  if (!parameters) parameters = FetchPrivateParameters();
  if (parameters->getType() != XmlRpcValue::TypeStruct || !parameters->hasMember(name)) {
    return std::nullopt;
  }
  return AsText((*parameters)[name]);
}

}  // namespace kinescope::ros_bridge
