#include "server/ros/master_client.h"

#include <ros/master.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <utility>

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

MasterClient::MasterClient(std::string host, int port) : host_(std::move(host)), port_(port) {}

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
  XmlRpcValue all;
  all[0] = ros::this_node::getName();
  for (int i = 0; arguments.valid() && i < arguments.size(); ++i) all[i + 1] = arguments[i];

  XmlRpc::XmlRpcClient client(host_.c_str(), port_, "/");
  if (!client.executeNonBlock(method, all)) return {};
  client._disp.work(std::chrono::duration<double>(timeout).count());
  XmlRpcValue response;
  if (!client.executeCheckDone(response) || client.isFault()) return {};
  return Unwrap(response);
}

}  // namespace kinescope::ros_bridge
