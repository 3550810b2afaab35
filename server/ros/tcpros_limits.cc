#include "server/ros/tcpros_limits.h"

#include <ros/connection.h>
#include <ros/transport/transport_tcp.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <limits>
#include <string>

#include "server/ros/original_function.h"
#include "server/ros/xmlrpc_limits.h"

namespace kinescope::ros_bridge {
namespace {

std::atomic<std::uint32_t> most_tcpros_bytes{std::numeric_limits<std::uint32_t>::max()};

}  // namespace

void LimitTcprosMessages(std::uint32_t most_bytes) { most_tcpros_bytes = most_bytes; }

}  // namespace kinescope::ros_bridge

namespace ros {

namespace limits = kinescope::ros_bridge;

// Called with the length that the other side states, before the memory is allocated.
void Connection::read(std::uint32_t size, const ReadFinishedFunc& callback) {
  static const auto original =
      limits::Original<void (*)(Connection*, std::uint32_t, const ReadFinishedFunc&)>(
          "_ZN3ros10Connection4readEjRKN5boost8functionIFvRKNS1_10shared_ptrIS0_EERKNS1_12shared_"
          "arrayIhEEjbEEE");
  const std::uint32_t most = limits::most_tcpros_bytes;
  if (size <= most) return original(this, size, callback);
  const std::string reason = fmt::format("a TCPROS message of more than {} MiB", most >> 20U);
  if (limits::CountRejection(reason) == 1) {
    spdlog::warn("a ROS connection was closed because of {}: {}", reason, getRemoteString());
  }
  drop(HeaderError);
}

// 0: nothing to read now. roscpp then waits for the next event, which comes at once.
std::int32_t TransportTCP::read(std::uint8_t* buffer, std::uint32_t size) {
  static const auto original =
      limits::Original<std::int32_t (*)(TransportTCP*, std::uint8_t*, std::uint32_t)>(
          "_ZN3ros12TransportTCP4readEPhj");
  thread_local int reads = 0;
  reads = (reads + 1) % (limits::kMostTcprosReads + 1);
  return reads == 0 ? 0 : original(this, buffer, size);
}

}  // namespace ros
