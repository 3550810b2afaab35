/// Limits what this process takes from the connections of TCPROS: messages of publishers and
/// headers of other nodes. Without it, roscpp allocates up to 1 GB as soon as a message states such
/// a length, and reads from a publisher that floods for as long as it does, so that this node
/// cannot be shut down.
///
/// As in xmlrpc_limits.h, tcpros_limits.cc defines two functions of roscpp again. A test proves
/// that they are used.
#pragma once

#include <cstdint>

namespace kinescope::ros_bridge {

/// Reads in a row from connections before roscpp's thread turns to its other work.
inline constexpr int kMostTcprosReads = 256;

/// A longer message or header is read and forgotten, and counted (RejectedXmlRpc); an empty one
/// takes its place, and the connection stays. Any thread.
void LimitTcprosMessages(std::uint32_t most_bytes);

}  // namespace kinescope::ros_bridge
