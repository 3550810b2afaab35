/// Bags of people whom a test knows, and what is read from them.
#pragma once

#include <gtest/gtest.h>
#include <rosbag/bag.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/transforms.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/test_person.h"
#include "tests/temp_folder.h"

namespace kinescope::ros_bridge {

// Bytes that claim to be a message of some type, true or not.
struct AnyBytes {
  static inline std::string datatype;
  static inline std::string md5;
  std::vector<std::uint8_t> bytes;
};

}  // namespace kinescope::ros_bridge

namespace ros {
namespace message_traits {
using kinescope::ros_bridge::AnyBytes;
template <>
struct MD5Sum<AnyBytes> {
  static const char* value() { return AnyBytes::md5.c_str(); }
  static const char* value(const AnyBytes&) { return value(); }
};
template <>
struct DataType<AnyBytes> {
  static const char* value() { return AnyBytes::datatype.c_str(); }
  static const char* value(const AnyBytes&) { return value(); }
};
template <>
struct Definition<AnyBytes> {
  static const char* value() { return ""; }
  static const char* value(const AnyBytes&) { return value(); }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<kinescope::ros_bridge::AnyBytes> {
  template <class Stream>
  static void write(Stream& stream, const kinescope::ros_bridge::AnyBytes& message) {
    std::copy(message.bytes.begin(), message.bytes.end(),
              stream.advance(static_cast<std::uint32_t>(message.bytes.size())));
  }
  static std::uint32_t serializedLength(const kinescope::ros_bridge::AnyBytes& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace kinescope::ros_bridge {

constexpr std::int64_t kBagStart = 1'700'000'000'000 * kNanosPerMilli;
constexpr std::int64_t kBagPeriod = 10 * kNanosPerMilli;

struct ReadPeople : kinescope::testing::RecordingSink {
  SourceCounters counters;
  double rate_hz = 0;
};

inline ReadPeople ReadBag(const std::string& path, const std::string& tf_topic = "") {
  ReadPeople recorded;
  const auto source = OpenBag(path, {{}, {}, tf_topic});
  EXPECT_FALSE(source->is_live());
  EXPECT_EQ(source->description(), path);
  while (source->Poll(std::chrono::milliseconds(0), recorded) == Source::State::kMore) {
  }
  EXPECT_EQ(source->Poll(std::chrono::milliseconds(0), recorded), Source::State::kEnded);
  recorded.counters = source->counters();
  recorded.rate_hz = source->nominal_rate_hz();
  return recorded;
}

inline std::string RefusalOf(const std::string& path, const std::string& tf_topic = "") {
  try {
    ReadBag(path, tf_topic);
  } catch (const SourceError& error) {
    return error.what();
  }
  return "it was read";
}

inline ros::Time RosTimeOf(std::int64_t nanos) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(nanos));
  return time;
}

// The n-th sample of a person who moves a little each time.
inline PersonState PersonAt(int n, const std::string& model = "skeleton") {
  return kinescope::testing::MakePerson(kinescope::testing::MakeModel(model),
                                        kinescope::testing::Posture(0.05 * n),
                                        static_cast<std::uint32_t>(n), kBagStart + n * kBagPeriod);
}

inline tf2_msgs::TFMessage TransformsOf(const PersonState& person, TfShape shape = TfShape::kFlat) {
  tf2_msgs::TFMessage message;
  FillTransforms(person, PersonNames(person.model->human.model_name), "world", shape, message);
  return message;
}

inline void ExpectPoses(const BodySample& sample, const PersonState& person,
                        double tolerance = 1e-12) {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const SegmentState& got = sample.segments[At(segment)];
    const SegmentState& sent = person.sample.segments[At(segment)];
    const std::string_view name = urdf::kSegments[At(segment)].link_name;
    EXPECT_LT((got.position - sent.position).norm(), tolerance) << name;
    EXPECT_LT(got.orientation.angularDistance(sent.orientation), 1e-7) << name;
    EXPECT_NEAR(got.orientation.norm(), 1, 1e-12) << name;
  }
}

class BagTest : public ::testing::Test {
 protected:
  void SetUp() override {
    AnyBytes::datatype = "tf/tfMessage";
    AnyBytes::md5 = ros::message_traits::md5sum<tf2_msgs::TFMessage>();
  }

  std::string path() const { return folder_ / "recording.bag"; }

  // A bag of what `write` writes.
  template <class Write>
  std::string Bag(const Write& write,
                  rosbag::CompressionType compression = rosbag::compression::Uncompressed) {
    rosbag::Bag bag(path(), rosbag::bagmode::Write);
    bag.setCompression(compression);
    write(bag);
    bag.close();
    return path();
  }

  kinescope::testing::TempFolder folder_;
};

}  // namespace kinescope::ros_bridge
