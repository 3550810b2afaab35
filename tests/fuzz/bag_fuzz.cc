// Any bytes as a ROS bag, read to the end: messages in order of time, each with all its bytes or
// with none, and an ending with a reason if it is not a good one.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>

#include "core/system/check.h"
#include "core/system/input_file.h"
#include "server/ros/source/bag_messages.h"

namespace bag_fuzz {
namespace {

using namespace kinescope;
using namespace kinescope::ros_bridge;

constexpr std::uint64_t kMostMessages = 100'000;  // lz4 packs millions of them into a small chunk

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;  // fmemopen takes no empty buffer
  const auto is_wanted = [](const BagConnection& connection) { return connection.topic == "/tf"; };
  BagMessages messages(InputFile(fmemopen(const_cast<std::uint8_t*>(data), size, "rb")), is_wanted);
  BagMessage message;
  std::int64_t newest = std::numeric_limits<std::int64_t>::min();
  std::uint64_t wanted = 0;
  while (messages.Next(message)) {
    KINESCOPE_CHECK(message.connection != nullptr && is_wanted(*message.connection));
    KINESCOPE_CHECK(message.bytes.size() == message.size ||
                    (message.bytes.empty() && message.size > BagReader::kLargestMessage));
    // All of a small bag is in the window.
    KINESCOPE_CHECK(message.recorded_nanos >= newest || messages.read() > kMostMessages ||
                    size > BagMessages::kWindowBytes);
    newest = message.recorded_nanos;
    if (++wanted > kMostMessages) return 0;
  }
  std::uint64_t others = 0;
  for (const auto& [topic, count] : messages.others()) others += count;
  KINESCOPE_CHECK(wanted + others == messages.read());
  const BagReader::Ending& ending = messages.ending();
  const bool has_reason = ending.kind == BagReader::Ending::Kind::kDamaged ||
                          ending.kind == BagReader::Ending::Kind::kUnreadable;
  KINESCOPE_CHECK(has_reason == !ending.reason.empty());
  return 0;
}

}  // namespace bag_fuzz
