// Datagrams that a real MVN sent. They are not part of this repository: see tests/shared_data.h.
#include <gtest/gtest.h>

#include <algorithm>
#include <bitset>
#include <map>

#include "server/mvn/assembler.h"
#include "server/mvn/datagram.h"
#include "tests/server/mvn/mvn_testing.h"
#include "tests/shared_data.h"

namespace kinescope::mvn {
namespace {

using ::kinescope::testing::ReadFile;
using ::kinescope::testing::SharedData;
using testing::RecordingSink;

Message Recorded(const std::string& file) {
  const auto message = ParseDatagram(ReadFile(SharedData(file)));
  if (!message) {
    ADD_FAILURE() << file << ": " << Describe(message.error());
    return {};
  }
  return *message;
}

TEST(RecordedDatagram, HasTheCounterTimeCodeAndPelvisOfItsBytes) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  const Message message = Recorded("udp/mxtp02.bin");
  EXPECT_EQ(message.header.sample_counter, 6681U);
  EXPECT_EQ(message.header.time_code_millis, 27837U);
  EXPECT_EQ(message.header.body_segments, 23);
  const auto& pose = std::get<PoseMessage>(message.body);
  EXPECT_TRUE(pose.HasBody());
  EXPECT_EQ(pose.present.count(), 23U) << "no gloves, no props";
  EXPECT_EQ(pose.skipped, 0);
  const PoseItem& pelvis = pose.items[urdf::kPelvis];
  EXPECT_NEAR(pelvis.position.x(), 0.068977, 1e-6);
  EXPECT_NEAR(pelvis.position.y(), 0.410732, 1e-6);
  EXPECT_NEAR(pelvis.position.z(), 1.048348, 1e-6);
  EXPECT_NEAR(pelvis.orientation.w(), 0.988978, 1e-6);
  EXPECT_NEAR(pelvis.orientation.z(), -0.128796, 1e-6);
}

// 01 says it in centimetres, degrees and Y-up, 02 in metres, quaternions and Z-up.
TEST(RecordedDatagram, HasEqualEulerAndQuaternionPosesToFloatPrecision) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp01.bin");
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  const Message euler_message = Recorded("udp/mxtp01.bin");
  const Message pose_message = Recorded("udp/mxtp02.bin");
  EXPECT_EQ(euler_message.header.sample_counter, pose_message.header.sample_counter);
  EXPECT_EQ(euler_message.header.time_code_millis, pose_message.header.time_code_millis);
  const auto& euler = std::get<EulerPoseMessage>(euler_message.body);
  const auto& pose = std::get<PoseMessage>(pose_message.body);
  ASSERT_TRUE(euler.HasBody());
  ASSERT_TRUE(pose.HasBody());
  EXPECT_EQ(euler.present, pose.present);
  for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
    const std::string_view name = urdf::kSegments[i].mvn_name;
    // Half a unit in the last place of a float between 128 and 256, the largest here, in cm.
    EXPECT_LT((euler.items[i].position - pose.items[i].position).norm(), 3e-7) << name;
    EXPECT_LT(euler.items[i].orientation.angularDistance(pose.items[i].orientation), 5e-7) << name;
  }
}

TEST(RecordedDatagram, HasNameAndColourInItsMetaData) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp12.bin");
  const Message message = Recorded("udp/mxtp12.bin");
  const auto& meta = std::get<MetaDataMessage>(message.body);
  EXPECT_EQ(meta.name, "Factory");
  EXPECT_EQ(meta.color_rgb, 0xE96417U);
}

struct TPoseRow {
  urdf::Segment segment;
  double x, y, z;
};

// The right side and the middle; the left side mirrors the right in y.
constexpr TPoseRow kTPose[] = {
    {urdf::kPelvis, 0, 0, 1.0521},
    {urdf::kL5, -.0125, 0, 1.1647},
    {urdf::kL3, -.0125, 0, 1.2904},
    {urdf::kT12, -.0125, 0, 1.4052},
    {urdf::kT8, -.0124, 0, 1.5199},
    {urdf::kNeck, -.0124, 0, 1.6801},
    {urdf::kHead, -.0125, 0, 1.7869},
    {urdf::kRightShoulder, -.0124, -.0348, 1.6097},
    {urdf::kRightUpperArm, -.0124, -.1968, 1.6097},
    {urdf::kRightForeArm, -.0124, -.5420, 1.6097},
    {urdf::kRightHand, -.0124, -.8244, 1.6097},
    {urdf::kRightUpperLeg, 0, -.0924, 1.0521},
    {urdf::kRightLowerLeg, 0, -.0924, .5755},
    {urdf::kRightFoot, 0, -.0924, .1088},
    {urdf::kRightToe, .2009, -.0924, .0205},
};

TEST(RecordedDatagram, HasTheTPoseInItsScaleData) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp13.bin");
  const Message message = Recorded("udp/mxtp13.bin");
  EXPECT_EQ(message.header.item_count, 0);
  EXPECT_FALSE(message.header.is_last_part) << "points follow in further datagrams";
  const auto& scale = std::get<ScaleMessage>(message.body);
  ASSERT_EQ(scale.segments.size(), 23U);
  EXPECT_TRUE(scale.points.empty());
  for (std::size_t i = 0; i < scale.segments.size(); ++i) {
    EXPECT_EQ(scale.segments[i].name, urdf::kSegments[i].mvn_name);
  }
  for (const TPoseRow& row : kTPose) {
    const auto index = static_cast<std::size_t>(row.segment);
    const Eigen::Vector3d expected(row.x, row.y, row.z);
    EXPECT_LT((scale.segments[index].origin_in_world - expected).norm(), 1e-4)
        << scale.segments[index].name;
    if (row.y == 0) continue;
    const std::size_t left = index + 4;
    const Eigen::Vector3d mirrored(row.x, -row.y, row.z);
    EXPECT_LT((scale.segments[left].origin_in_world - mirrored).norm(), 1e-4)
        << scale.segments[left].name;
  }
}

TEST(RecordedDatagram, HasAPoseThatMovesTheTPoseToItsPositions) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp13.bin");
  const Message pose_message = Recorded("udp/mxtp02.bin");
  const Message scale_message = Recorded("udp/mxtp13.bin");
  const auto& pose = std::get<PoseMessage>(pose_message.body);
  const auto& scale = std::get<ScaleMessage>(scale_message.body);
  ASSERT_EQ(scale.segments.size(), 23U);
  for (std::size_t i = 1; i < urdf::kSegmentCount; ++i) {
    const auto parent = static_cast<std::size_t>(urdf::kSegments[i].parent);
    const Eigen::Vector3d bone =
        scale.segments[i].origin_in_world - scale.segments[parent].origin_in_world;
    const Eigen::Vector3d chained =
        pose.items[parent].position + pose.items[parent].orientation * bone;
    const double tolerance = i == urdf::kL5 ? 0.013 : 0.003;  // MVN's segments are not quite rigid
    EXPECT_LT((chained - pose.items[i].position).norm(), tolerance) << urdf::kSegments[i].mvn_name;
  }
}

TEST(RecordedDatagram, GivesASampleACharacterAndASkeleton) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp13.bin");
  Assembler assembler;
  RecordingSink sink;
  std::int64_t now = 1'000'000'000;
  for (const char* file :
       {"udp/mxtp12.bin", "udp/mxtp13.bin", "udp/mxtp01.bin", "udp/mxtp02.bin"}) {
    assembler.Add({}, ReadFile(SharedData(file)), {now, now}, sink);
  }
  assembler.Expire(now + 1'000'000'000, sink);  // the other parts of 13 were not recorded
  ASSERT_EQ(sink.samples.size(), 1U);
  EXPECT_EQ(sink.samples[0].counter, 6681U);
  ASSERT_FALSE(sink.characters.empty());
  const Character& character = sink.characters.back();
  EXPECT_EQ(character.name, "Factory");
  ASSERT_TRUE(character.skeleton);
  EXPECT_NEAR(character.skeleton->origin_in_parent[urdf::kRightForeArm].norm(), 0.3452, 1e-3);
  EXPECT_NEAR(character.skeleton->height, 1.98, 0.06) << "hips at 1.05 m: a tall person";
  EXPECT_EQ(assembler.counters().types,
            (std::map<std::string, std::uint64_t>{{"01", 1}, {"02", 1}, {"12", 1}, {"13", 1}}));
  EXPECT_TRUE(assembler.counters().rejected.empty());
}

// Seven trackers of a lower body, lying on a table; 17 is picked up from datagram 40 on.
class RecordedTrackers : public ::testing::Test {
 protected:
  static constexpr std::size_t kDatagramBytes = 500;
  static constexpr std::size_t kDatagrams = 150;
  static constexpr std::size_t kUntouched = 40;
  static constexpr const char* kFile = "udp/mxtp23_lowerbody_000-149.bin";

  // Nothing where the recording is absent.
  static std::vector<std::string> Datagrams() {
    const std::string all = ReadFile(SharedData(kFile));
    std::vector<std::string> datagrams;
    for (std::size_t at = 0; at < all.size(); at += kDatagramBytes) {
      datagrams.push_back(all.substr(at, kDatagramBytes));
    }
    return datagrams;
  }
};

TEST_F(RecordedTrackers, MeasureGravityAndTheMagneticFieldOfTheEarth) {
  KINESCOPE_NEEDS_SHARED_DATA(kFile);
  const auto datagrams = Datagrams();
  ASSERT_EQ(datagrams.size(), kDatagrams);
  std::bitset<urdf::kSegmentCount> expected;
  for (const int id : {1, 16, 17, 18, 20, 21, 22}) expected.set(static_cast<std::size_t>(id) - 1);
  std::uint32_t counter = 0;
  for (std::size_t n = 0; n < datagrams.size(); ++n) {
    const auto message = ParseDatagram(datagrams[n]);
    ASSERT_TRUE(message) << "datagram " << n << ": " << Describe(message.error());
    EXPECT_EQ(message->header.type, Type::kTrackers);
    EXPECT_EQ(message->header.item_count, 7);
    EXPECT_EQ(message->header.body_segments, 23);
    EXPECT_GT(message->header.sample_counter, counter);
    EXPECT_LE(message->header.sample_counter, n == 0 ? ~0U : counter + 10);
    counter = message->header.sample_counter;
    const auto& body = std::get<TrackersMessage>(message->body);
    ASSERT_EQ(body.present, expected) << "datagram " << n;
    EXPECT_EQ(body.skipped, 0);
    for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
      if (!expected.test(i)) continue;
      const TrackerState& tracker = body.trackers[i];
      const std::string where =
          "datagram " + std::to_string(n) + ", tracker " + std::to_string(i + 1);
      EXPECT_TRUE(tracker.has_rates) << where;
      EXPECT_NEAR(tracker.orientation.norm(), 1, 1e-9) << where;
      EXPECT_GT(tracker.magnetic_field.norm(), 0.2) << where;
      EXPECT_LT(tracker.magnetic_field.norm(), 2) << where;
      if (n >= kUntouched && i == urdf::kRightLowerLeg) continue;
      EXPECT_NEAR(tracker.acceleration.norm(), 9.8, 0.3) << where << " lies still";
      EXPECT_LT(tracker.angular_velocity.norm(), 0.3) << where << " lies still";
      EXPECT_LT(tracker.free_acceleration.norm(), 0.5) << where << " lies still";
    }
  }
}

TEST_F(RecordedTrackers, MoveWhenPickedUp) {
  KINESCOPE_NEEDS_SHARED_DATA(kFile);
  double fastest_before = 0;
  double fastest_after = 0;
  const auto datagrams = Datagrams();
  for (std::size_t n = 0; n < datagrams.size(); ++n) {
    const auto message = ParseDatagram(datagrams[n]);
    ASSERT_TRUE(message);
    const double speed = std::get<TrackersMessage>(message->body)
                             .trackers[urdf::kRightLowerLeg]
                             .angular_velocity.norm();
    double& fastest = n < kUntouched ? fastest_before : fastest_after;
    fastest = std::max(fastest, speed);
  }
  EXPECT_LT(fastest_before, 0.3);
  EXPECT_GT(fastest_after, 1);
}

TEST_F(RecordedTrackers, AreCountedAndGiveNoSampleWithoutAPose) {
  KINESCOPE_NEEDS_SHARED_DATA(kFile);
  Assembler assembler;
  RecordingSink sink;
  std::int64_t now = 1'000'000'000;
  for (const std::string& datagram : Datagrams()) {
    const auto header = ParseHeader(datagram);
    ASSERT_TRUE(header);
    now = 1'000'000'000 + std::int64_t{header->time_code_millis} * 1'000'000;
    assembler.Expire(now, sink);
    assembler.Add({}, datagram, {now, now}, sink);
  }
  assembler.Flush(sink);
  EXPECT_TRUE(sink.samples.empty());
  EXPECT_EQ(assembler.counters().types.at("23"), kDatagrams);
  EXPECT_EQ(assembler.counters().rejected,
            (std::map<std::string, std::uint64_t>{{Text(Reason::kNoWholePose), kDatagrams}}));
  EXPECT_EQ(assembler.tally().settled(), assembler.tally().datagrams);
}

}  // namespace
}  // namespace kinescope::mvn
