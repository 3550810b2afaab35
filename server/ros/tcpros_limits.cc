#include "server/ros/tcpros_limits.h"

#include <ros/connection.h>
#include <ros/transport/transport_tcp.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <string>

#include "server/ros/original_function.h"
#include "server/ros/xmlrpc_limits.h"

namespace kinescope::ros_bridge {
namespace {

std::atomic<std::uint32_t> most_tcpros_bytes{std::numeric_limits<std::uint32_t>::max()};

using ReadFunction = void (*)(ros::Connection*, std::uint32_t, const ros::ReadFinishedFunc&);

void CallOriginal(ros::Connection& connection, std::uint32_t size,
                  const ros::ReadFinishedFunc& callback) {
  static const auto original = Original<ReadFunction>(
      "_ZN3ros10Connection4readEjRKN5boost8functionIFvRKNS1_10shared_ptrIS0_EERKNS1_12shared_"
      "arrayIhEEjbEEE");
  original(&connection, size, callback);
}

// In parts, so that the memory is not that of the whole.
void Skip(ros::Connection& connection, std::uint32_t size, const ros::ReadFinishedFunc& callback) {
  constexpr std::uint32_t kPart = 1 << 20;
  const std::uint32_t part = std::min(size, kPart);
  CallOriginal(connection, part,
               [size, part, callback](const ros::ConnectionPtr& same,
                                      const boost::shared_array<std::uint8_t>& bytes,
                                      std::uint32_t read, bool is_read) {
                 if (is_read && size > part) return Skip(*same, size - part, callback);
                 callback(same, bytes, is_read ? 0 : read, is_read);
               });
}

// What the publisher has said of itself.
std::string TopicOf(ros::Connection& connection) {
  std::string topic;
  connection.getHeader().getValue("topic", topic);
  return topic.empty() ? connection.getRemoteString() : topic;
}

}  // namespace

void LimitTcprosMessages(std::uint32_t most_bytes) { most_tcpros_bytes = most_bytes; }

}  // namespace kinescope::ros_bridge

namespace ros {

namespace limits = kinescope::ros_bridge;

// Called with the length that the other side states, before the memory is allocated.
void Connection::read(std::uint32_t size, const ReadFinishedFunc& callback) {
  const std::uint32_t most = limits::most_tcpros_bytes;
  if (size <= most) return limits::CallOriginal(*this, size, callback);
  const std::string reason = fmt::format("a TCPROS message of more than {} MiB", most >> 20U);
  if (limits::CountRejection(reason) == 1) {
    spdlog::warn("{}: {} ({:.0f} MB) is not read; the next ones are, if they are smaller",
                 limits::TopicOf(*this), reason, 1e-6 * size);
  }
  limits::Skip(*this, size, callback);
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
