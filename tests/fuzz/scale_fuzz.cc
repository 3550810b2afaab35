// Groups of type 13 with parts lost, repeated, out of order and lying. The input is a row of
// records: datagram counter (1 byte), milliseconds since the one before in tens (1 byte), length (2
// bytes, big-endian), payload of a type 13.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/system/check.h"
#include "server/mvn/byte_order.h"
#include "server/mvn/scale_group.h"

namespace scale_fuzz {
namespace {

using namespace kinescope;

constexpr std::int64_t kWaitNanos = 10'000'000;
constexpr std::size_t kMaxRecords = 1000;

std::string DatagramOf(std::uint8_t counter, std::string_view payload) {
  std::string datagram = "MXTP13";
  mvn::ByteWriter out(datagram);
  out.Write(std::uint32_t{0});
  out.Write(counter);
  out.Write(std::uint8_t{0});
  out.Write(std::uint32_t{0});
  out.Write(std::uint32_t{23} << 16U);  // character, 23 segments, no props, no fingers
  out.Write(std::uint16_t{0});
  out.Write(static_cast<std::uint16_t>(payload.size()));
  return datagram.append(payload);
}

void Check(const mvn::ScaleGroup::Scale& scale) {
  KINESCOPE_CHECK(scale.scaled_segments.size() <= static_cast<std::size_t>(kFingerAndPropCount));
  for (const ScaledSegment& segment : scale.scaled_segments) {
    KINESCOPE_CHECK(segment.name.size() <= 128 && segment.origin_in_world.allFinite());
  }
  if (!scale.skeleton) return;
  KINESCOPE_CHECK(scale.skeleton->height > 0.4 && scale.skeleton->height < 2.8);
  for (const Eigen::Vector3d& origin : scale.skeleton->origin_in_parent) {
    KINESCOPE_CHECK(origin.norm() <= 1.0);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mvn::ByteReader in({reinterpret_cast<const char*>(data), size});
  mvn::ScaleGroup group;
  std::int64_t now = 0;
  std::uint8_t counter = 0, wait = 0;
  std::uint16_t length = 0;
  std::string_view payload;
  for (std::size_t i = 0; i < kMaxRecords && in.Read(counter) && in.Read(wait) && in.Read(length) &&
                          in.ReadBytes(length, payload);
       ++i) {
    now += wait * kWaitNanos;
    const auto message = mvn::ParseDatagram(DatagramOf(counter, payload));
    if (message) group.Add(message->header, std::get<mvn::ScaleMessage>(message->body), now);
    if (const auto scale = group.Take(now)) {
      Check(*scale);
      KINESCOPE_CHECK(!group.Take(now) && !group.deadline_nanos());  // once
    }
  }
  if (const auto deadline = group.deadline_nanos()) {
    const auto scale = group.Take(*deadline);
    KINESCOPE_CHECK(scale.has_value());
    Check(*scale);
  }
  return 0;
}

}  // namespace scale_fuzz
