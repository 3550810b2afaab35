#include "server/ros/init.h"

#include <ros/console.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <xmlrpcpp/XmlRpcUtil.h>

#include <atomic>
#include <chrono>
#include <cstdlib>
#include <mutex>
#include <set>
#include <string>
#include <utility>

#include "core/system/errors.h"
#include "server/ros/bridge.h"
#include "server/ros/master_client.h"
#include "server/ros/node_time.h"
#include "server/ros/xmlrpc_limits.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

// roscpp has one node per process, so its command line arguments belong to the process, too.
struct RosArguments {
  std::string default_name = "kinescope";
  std::map<std::string, std::string> remappings;          // without private parameters
  std::map<std::string, std::string> private_parameters;  // by name, without the underscore
};

RosArguments& MutableArguments() {
  static RosArguments arguments;
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

// roscpp aborts the process if it cannot parse an address.
void CheckMasterUri(const std::map<std::string, std::string>& remappings) {
  const auto remapped = remappings.find("__master");
  const char* from_environment = std::getenv("ROS_MASTER_URI");
  const bool is_set = from_environment != nullptr || remapped != remappings.end();
  if (!is_set) return;
  const std::string uri = remapped != remappings.end() ? remapped->second : from_environment;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port) || port == 0 || port > 65535) {
    throw UsageError(fmt::format("ROS_MASTER_URI={}: expected http://<host>:<port>", uri));
  }
}

// roscpp takes the folder of its log from the environment, creates ~/.ros/log without one, and
// stops the process if that is impossible; then it writes nothing there. It does neither with a
// file name.
void ChooseLogFile(std::map<std::string, std::string>& remappings) {
  const bool is_chosen =
      std::getenv("ROS_LOG_DIR") != nullptr || std::getenv("ROS_HOME") != nullptr;
  if (!is_chosen) remappings.try_emplace("__log", "/dev/null");
}

NodeParameter ToParameter(XmlRpcValue& value) {
  using Kind = NodeParameter::Kind;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return {Kind::kSwitch, {static_cast<bool>(value) ? "true" : "false"}};
    case XmlRpcValue::TypeInt: return {Kind::kText, {fmt::format("{}", static_cast<int>(value))}};
    case XmlRpcValue::TypeDouble:
      return {Kind::kText, {fmt::format("{}", static_cast<double>(value))}};
    case XmlRpcValue::TypeString: return {Kind::kText, {static_cast<std::string>(value)}};
    case XmlRpcValue::TypeArray: break;
    default: return {Kind::kOther};
  }
  NodeParameter list{Kind::kList};
  for (int i = 0; i < value.size(); ++i) {
    const NodeParameter item = ToParameter(value[i]);
    if (item.texts.size() != 1 || item.kind == Kind::kList) return {Kind::kOther};
    list.texts.push_back(item.texts.front());
  }
  return list;
}

// One lost packet can cost more than a second; a master that never answers must not keep the
// program from starting, or from saying that it cannot, within 3 s.
constexpr std::chrono::milliseconds kParametersPatience{2400}, kStartPatience{2900};

std::atomic<bool> parameters_were_late{false};

// Fetches all parameters at the first call: a master that does not answer then costs one timeout
// and not one per option.
XmlRpcValue FetchPrivateParameters() {
  XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  const MasterReply reply = MasterClient().Call("getParam", arguments, kParametersPatience);
  if (reply.is_late) {
    parameters_were_late = true;
    spdlog::warn(
        "the ROS master at {} has not answered within {:.1f} s: the parameters of {} are not used; "
        "if it has some (rosparam get {}), restart the node once the master answers",
        MasterUri(), std::chrono::duration<double>(kParametersPatience).count(),
        ros::this_node::getName(), ros::this_node::getName());
  }
  return reply.code == MasterReply::Code::kGood ? reply.value : XmlRpcValue();
}

}  // namespace

const std::map<std::string, std::string>& PrivateArguments() {
  return MutableArguments().private_parameters;
}

bool BuiltWithRos() { return true; }

void TakeRosArguments(int& argc, char** argv, const std::string& default_name) {
  RosArguments& arguments = MutableArguments();
  arguments.default_name = default_name;
  int kept = 0;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t sign = i > 0 ? argument.find(":=") : argument.npos;
    if (sign == argument.npos) {
      argv[kept++] = argv[i];
      continue;
    }
    const std::string name = argument.substr(0, sign), value = argument.substr(sign + 2);
    // Otherwise roscpp would send `_name:=value` to the master on starting, and wait for one
    // without limit.
    if (sign > 1 && name[0] == '_' && name[1] != '_') {
      arguments.private_parameters[name.substr(1)] = value;
    } else {
      arguments.remappings[name] = value;
    }
  }
  argc = kept;
}

std::vector<std::string> TakenRosArguments() {
  std::vector<std::string> all;
  for (const auto& [name, value] : MutableArguments().remappings) {
    all.push_back(name + ":=" + value);
  }
  for (const auto& [name, value] : PrivateArguments()) all.push_back("_" + name + ":=" + value);
  return all;
}

void InitRos() {
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  if (ros::isInitialized()) return;
  const RosArguments& arguments = MutableArguments();
  std::map<std::string, std::string> remappings = arguments.remappings;
  CheckMasterUri(remappings);
  ChooseLogFile(remappings);
  SilenceXmlRpc();
  try {
    // Kinescope handles Ctrl-C itself, and logs to the terminal and not to /rosout.
    ros::init(remappings, arguments.default_name,
              ros::init_options::NoSigintHandler | ros::init_options::NoRosout);
  } catch (const ros::Exception& error) {
    throw UsageError(fmt::format("ROS does not accept these names: {}", error.what()));
  }
  AnswerWithTime();
}

std::string MasterUri() {
  InitRos();
  return ros::master::getURI();
}

bool MasterIsReachable() {
  InitRos();
  return MasterClient().Call("getPid", XmlRpcValue(), std::chrono::seconds(1)).code ==
         MasterReply::Code::kGood;
}

std::chrono::milliseconds StartPatienceLeft() {
  return parameters_were_late ? kStartPatience - kParametersPatience : kStartPatience;
}

void HurryRoscpp() {
  ros::master::setRetryTimeout(ros::WallDuration(0.001));  // 0 would be without limit
  LimitLastXmlRpcCalls(kLastPatience);
}

void LeaveRos() {
  if (!ros::isStarted()) return;
  // roscpp unregisters topic by topic without a time limit: a master on a machine that was switched
  // off would delay the exit for minutes. So its address is removed first.
  if (!MasterIsReachable()) const_cast<std::string&>(ros::master::getHost()).clear();
  HurryRoscpp();
  ros::shutdown();
}

const std::map<std::string, NodeParameter>& PrivateParameters() {
  static const std::map<std::string, NodeParameter> kAll = [] {
    InitRos();
    std::map<std::string, NodeParameter> all;
    for (const auto& [name, value] : PrivateArguments()) all[name].texts = {value};
    XmlRpcValue of_master = FetchPrivateParameters();
    if (of_master.getType() != XmlRpcValue::TypeStruct) return all;
    for (auto& [name, value] : of_master) all.try_emplace(name, ToParameter(value));
    return all;
  }();
  return kAll;
}

}  // namespace kinescope::ros_bridge

namespace ros::console {
namespace {

// A line is logged once: roscpp repeats some with every attempt.
bool IsFirstTime(const std::string& line) {
  constexpr std::size_t kMostLines = 256;
  static std::mutex mutex;
  static std::set<std::string> lines;  // guarded by mutex
  const std::lock_guard<std::mutex> lock(mutex);
  if (lines.size() >= kMostLines) lines.clear();
  return lines.insert(line).second;
}

}  // namespace

// roscpp's own log lines, which it would write to the terminal itself, with colours. Defined again
// as the functions of xmlrpc_limits.h are.
void Formatter::print(void* /*logger*/, Level level, const char* text, const char* /*file*/,
                      const char* /*function*/, int /*line*/) {
  if (text == nullptr || !IsFirstTime(text)) return;
  const auto severity = level >= levels::Error  ? spdlog::level::err
                        : level == levels::Warn ? spdlog::level::warn
                        : level == levels::Info ? spdlog::level::info
                                                : spdlog::level::debug;
  spdlog::log(severity, "ROS: {}", text);
}

}  // namespace ros::console
