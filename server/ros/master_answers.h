/// The answers that the APIs of the ROS master and of nodes define for each method: [status,
/// message, value], with a value of a certain type. roscpp relies on the types: XmlRpc++ throws for
/// a wrong one, on threads that nothing catches on.
#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <string_view>

namespace kinescope::ros_bridge {

/// Publishers of one topic in an answer or a request. roscpp compares each with each.
inline constexpr int kMostPublishers = 512;

/// Why `answer` is not one of the method `method`, such as "answered hasParam with a string"; ""
/// if it is. Of an unknown method every answer is accepted. Any thread.
std::string DefectOfAnswer(std::string_view method, const XmlRpc::XmlRpcValue& answer);

/// The same for the arguments of a call of this node; only publisherUpdate is checked here, which
/// any host can call.
std::string DefectOfRequest(std::string_view method, const XmlRpc::XmlRpcValue& arguments);

/// "a string", "an array": the type of a value in messages.
std::string TypeNameOf(const XmlRpc::XmlRpcValue& value);

}  // namespace kinescope::ros_bridge
