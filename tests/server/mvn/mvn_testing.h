/// What the tests of the MVN stream share: seeded samples, datagrams by hand, a sink that
/// remembers.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "core/source.h"
#include "core/system/errors.h"
#include "server/mvn/byte_order.h"
#include "server/mvn/datagram.h"
#include "tests/recording_sink.h"

namespace kinescope::mvn::testing {

/// What `action` is refused with as a source; "": it is not.
template <class Action>
std::string ErrorOf(const Action& action) {
  try {
    action();
  } catch (const SourceError& error) {
    return error.what();
  }
  return "";
}

using ::kinescope::testing::RecordingSink;

/// Values that a float holds exactly (up to 4096), so that a round trip through the wire is exact.
class RandomValues {
 public:
  explicit RandomValues(std::uint32_t seed) : engine_(seed) {}

  double Number(double scale) {
    // On a grid and not by a cast to float: GCC 12 optimises that away where it vectorises.
    constexpr double kGrid = 4096;
    return std::round(std::uniform_real_distribution<double>(-scale, scale)(engine_) * kGrid) /
           kGrid;
  }
  int Integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool Coin(double chance) { return std::bernoulli_distribution(chance)(engine_); }
  Eigen::Vector3d Vector(double scale) {
    const double x = Number(scale);
    const double y = Number(scale);
    return {x, y, Number(scale)};
  }
  Eigen::Quaterniond Turn() {
    std::normal_distribution<double> normal;
    const double w = normal(engine_);
    const double x = normal(engine_);
    const double y = normal(engine_);
    return Eigen::Quaterniond(w, x, y, normal(engine_)).normalized();
  }
  std::mt19937& engine() { return engine_; }

 private:
  std::mt19937 engine_;
};

/// A sample with everything in it.
inline BodySample RandomSample(RandomValues& random, std::uint32_t counter) {
  BodySample sample;
  sample.counter = counter;
  sample.time_code_millis = static_cast<std::int64_t>(std::llround(counter * 1000.0 / 240.0));
  for (SegmentState& segment : sample.segments) {
    segment.position = random.Vector(2);
    segment.orientation = random.Turn();
    segment.velocity = random.Vector(5);
    segment.acceleration = random.Vector(50);
    segment.angular_velocity = random.Vector(10);
    segment.angular_acceleration = random.Vector(100);
  }
  sample.has_linear = sample.has_angular = true;
  sample.com = CenterOfMass{random.Vector(2), random.Vector(5), random.Vector(50), true};
  sample.streamed_angles_deg.emplace();
  for (Eigen::Vector3d& angles : *sample.streamed_angles_deg) angles = random.Vector(180);
  return sample;
}

/// A sample with gloves, two props, every sensor and a time of day as well.
inline BodySample RandomFullSample(RandomValues& random, std::uint32_t counter) {
  BodySample sample = RandomSample(random, counter);
  sample.utc_millis_of_day = static_cast<std::int32_t>(counter % 86'400'000);
  for (int i = 0; i < kFingerAndPropCount; ++i) {
    if (i >= 2 && i < kMaxProps) continue;
    sample.fingers_and_props.present.set(static_cast<std::size_t>(i));
    sample.fingers_and_props.poses[static_cast<std::size_t>(i)] = {random.Vector(2), random.Turn()};
  }
  for (std::size_t i = 0; i < sample.trackers.size(); i += 2) {
    sample.has_tracker.set(i);
    TrackerState& tracker = sample.trackers[i];
    tracker = {random.Turn(),    random.Vector(50), random.Vector(50),
               random.Vector(9), random.Vector(1),  true};
  }
  return sample;
}

/// "4d58 5450" as bytes; white space is for the reader.
inline std::string FromHex(const std::string& hex) {
  std::string bytes;
  std::string digits;
  for (const char c : hex) {
    if (c == ' ' || c == '\n') continue;
    digits.push_back(c);
    if (digits.size() < 2) continue;
    bytes.push_back(static_cast<char>(std::stoi(digits, nullptr, 16)));
    digits.clear();
  }
  return bytes;
}

/// Any datagram, also those that our encoder would never write.
struct RawDatagram {
  std::string type = "02";
  std::uint32_t counter = 1;
  int datagram_counter = 0x80;
  int items = 0;
  std::uint32_t time_code_millis = 4;
  int character = 0;
  int body_segments = 23;
  int props = 0;
  int fingers = 0;
  std::string payload;
  int announced_payload = -1;  // -1: its real size

  std::string Bytes() const {
    std::string bytes = "MXTP" + type;
    ByteWriter out(bytes);
    out.Write(counter);
    out.Write(static_cast<std::uint8_t>(datagram_counter));
    out.Write(static_cast<std::uint8_t>(items));
    out.Write(time_code_millis);
    for (const int byte : {character, body_segments, props, fingers, 0, 0})
      out.Write(static_cast<std::uint8_t>(byte));
    out.Write(static_cast<std::uint16_t>(announced_payload < 0 ? static_cast<int>(payload.size())
                                                               : announced_payload));
    return bytes + payload;
  }
};

/// Items of any type: an id, then `floats` numbers that are all `value`, but for a quaternion
/// w = 1 at `quaternion_at` (-1: none).
inline std::string Items(std::uint32_t first_id, int count, int floats, double value,
                         int quaternion_at = -1) {
  std::string payload;
  ByteWriter out(payload);
  for (int i = 0; i < count; ++i) {
    out.Write(first_id + static_cast<std::uint32_t>(i));
    for (int k = 0; k < floats; ++k) {
      const bool in_quaternion = quaternion_at >= 0 && k >= quaternion_at && k < quaternion_at + 4;
      out.WriteFloat(in_quaternion ? (k == quaternion_at ? 1.0 : 0.0) : value);
    }
  }
  return payload;
}

inline std::string PoseItems(std::uint32_t first_id, int count) {
  return Items(first_id, count, 7, 0.5, 3);
}

}  // namespace kinescope::mvn::testing
