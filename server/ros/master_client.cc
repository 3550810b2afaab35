#include "server/ros/master_client.h"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"
#include "server/ros/xmlrpc_limits.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

// The master's API returns everything as [status, message, value]; 1 is success.
MasterReply Unwrap(XmlRpcValue& response) {
  MasterReply reply;
  if (response.getType() != XmlRpcValue::TypeArray || response.size() != 3 ||
      response[0].getType() != XmlRpcValue::TypeInt) {
    return reply;  // the answer is not from a master
  }
  reply.code =
      static_cast<int>(response[0]) == 1 ? MasterReply::Code::kGood : MasterReply::Code::kRefused;
  reply.value = response[2];
  return reply;
}

}  // namespace

MasterClient::MasterClient()
    : host_(ros::master::getHost()), port_(static_cast<int>(ros::master::getPort())) {}

MasterClient::MasterClient(std::string host, int port, Connection connection)
    : host_(std::move(host)), port_(port), connection_(connection) {}

MasterClient::~MasterClient() = default;

bool MasterClient::SetParameter(const std::string& name, const XmlRpcValue& value) {
  XmlRpcValue arguments;
  arguments[0] = ros::names::resolve(name);
  arguments[1] = value;
  return Call("setParam", arguments).code == MasterReply::Code::kGood;
}

RegistrationState MasterClient::AskRegistration(const std::string& our_uri,
                                                std::chrono::milliseconds timeout) {
  XmlRpcValue arguments;
  arguments[0] = ros::this_node::getName();
  MasterReply reply = Call("lookupNode", arguments, timeout);
  if (reply.code == MasterReply::Code::kNoAnswer) return RegistrationState::kNoAnswer;
  const bool has_uri = !our_uri.empty() && reply.code == MasterReply::Code::kGood &&
                       reply.value.getType() == XmlRpcValue::TypeString;
  if (!has_uri) return RegistrationState::kUnknown;
  return static_cast<std::string>(reply.value) == our_uri ? RegistrationState::kKnown
                                                          : RegistrationState::kNameTaken;
}

std::optional<int> MasterClient::AskPid(std::chrono::milliseconds timeout) {
  MasterReply reply = Call("getPid", XmlRpcValue(), timeout);
  if (reply.code == MasterReply::Code::kNoAnswer) return std::nullopt;
  return reply.value.getType() == XmlRpcValue::TypeInt ? static_cast<int>(reply.value) : 0;
}

MasterReply MasterClient::Call(const char* method, const XmlRpcValue& arguments,
                               std::chrono::milliseconds timeout) {
  timeout = XmlRpcTimeLeft(timeout);
  XmlRpcValue all;
  all[0] = ros::this_node::getName();
  for (int i = 0; arguments.valid() && i < arguments.size(); ++i) all[i + 1] = arguments[i];

  if (!client_) client_ = std::make_unique<XmlRpc::XmlRpcClient>(host_.c_str(), port_, "/");
  XmlRpc::XmlRpcClient& client = *client_;
  client._header.clear();
  client._response.clear();
  TakeXmlRpcProblem();  // of an earlier call
  MasterReply reply;
  if (client.executeNonBlock(method, all)) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    // In short steps: the end of the program may leave less time meanwhile.
    constexpr std::chrono::milliseconds kStep(100), kNone(0);
    constexpr int kMostStepsOfEnd = 4;
    int steps_of_end = 0;
    bool is_late = false;
    while (true) {
      const auto now = std::chrono::steady_clock::now();
      const auto rest = std::chrono::ceil<std::chrono::milliseconds>(end - now);
      const auto step = std::min(kStep, XmlRpcTimeLeft(std::max(kNone, rest)));
      is_late = step == kNone || (StopRequested() && ++steps_of_end > kMostStepsOfEnd);
      if (is_late) break;
      client._disp.work(std::chrono::duration<double>(step).count());
      // With nothing left to wait for it returns at once.
      if (std::chrono::steady_clock::now() - now < step / 2) break;
    }
    reply.is_late = is_late;
    XmlRpcValue response;
    const bool has_begun = !client._header.empty() || !client._response.empty();
    const bool is_done = client.executeCheckDone(response);
    const std::string answered = "answered " + std::string(method) + " with ";
    if (!has_begun) {  // a refused connection, for one
    } else if (is_done && client.isFault()) {
      reply.problem = answered + "an XML-RPC fault";
    } else if (is_done && response.valid()) {
      reply = Unwrap(response);
    } else if (is_late) {
      reply.problem =
          "did not complete an answer within " + std::to_string(timeout.count()) + " ms";
    } else {
      reply.problem = answered + "something other than XML-RPC";
    }
  }
  const std::string rejected = TakeXmlRpcProblem();
  if (!rejected.empty()) {
    reply = {};
    reply.problem = StartsWith(rejected, "answered ") ? rejected : "sent " + rejected;
  }
  if (connection_ == Connection::kNew || reply.code == MasterReply::Code::kNoAnswer)
    client_.reset();
  problem_ = reply.problem;
  return reply;
}

std::optional<NodeServer> FindNodeServer(const std::string& node,
                                         std::chrono::milliseconds timeout) {
  XmlRpcValue name;
  name[0] = node;
  MasterReply found = MasterClient().Call("lookupNode", name, timeout);
  if (found.code != MasterReply::Code::kGood) return std::nullopt;
  std::string host;
  std::uint32_t port = 0;
  if (found.value.getType() != XmlRpcValue::TypeString) return std::nullopt;
  if (!ros::network::splitURI(found.value, host, port) || port > 65535) return std::nullopt;
  return NodeServer{host, static_cast<int>(port)};
}

bool DoesNodeAnswer(const std::string& node, std::chrono::milliseconds timeout) {
  const std::optional<NodeServer> server = FindNodeServer(node, timeout);
  if (!server) return false;
  MasterClient client(server->host, server->port);
  return client.Call("getPid", XmlRpcValue(), timeout).code == MasterReply::Code::kGood;
}

}  // namespace kinescope::ros_bridge
