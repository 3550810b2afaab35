/// Limits what this process accepts as XML-RPC: answers of a ROS master or a node, and requests of
/// any host to this node's own port. Without it, an answer that is nested deep enough ends the
/// process, as does one of another type than the method has (master_answers.h), and one without an
/// end takes all memory.
///
/// roscpp itself calls the master and serves the port, through XmlRpc++, which has no limits. So
/// xmlrpc_limits.cc defines some functions of that library again: in a program, its own definition
/// of a function takes precedence over that of a shared library, also for the calls inside the
/// library. A test proves that they are used.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace kinescope::ros_bridge {

inline constexpr std::size_t kLargestXmlRpcText = 4 << 20;  // bytes; a robot_description has less
inline constexpr std::size_t kLargestXmlRpcHeader = 64 << 10;  // bytes of HTTP header
inline constexpr int kDeepestXmlRpcValue = 32;                 // values inside values

/// Null, or why XmlRpc++ must not parse the value that begins at `offset` of `text`: nested too
/// deep, or not well-formed.
[[nodiscard]] const char* DefectOfXmlRpcValue(std::string_view text, std::size_t offset);

/// Limits the time that roscpp's own calls of a master take, which would wait for an answer without
/// limit. Negative: no limit. Any thread.
void LimitXmlRpcCalls(std::chrono::milliseconds timeout);

/// Limits the time of all further calls together, from the first time that it is called: the
/// shutdown of roscpp makes several per topic. Negative: no limit. Any thread.
void LimitLastXmlRpcCalls(std::chrono::milliseconds total);

/// What is left of `timeout` for a call; negative: no limit. Any thread.
std::chrono::milliseconds XmlRpcTimeLeft(std::chrono::milliseconds timeout);

/// Why the last text that this thread received was rejected; "" if none was since the last call.
std::string TakeXmlRpcProblem();

/// Counts what was rejected for `reason`, and returns how often that was. Any thread.
std::uint64_t CountRejection(const std::string& reason);

/// What was rejected, by reason. Any thread.
std::map<std::string, std::uint64_t> RejectedXmlRpc();

}  // namespace kinescope::ros_bridge
