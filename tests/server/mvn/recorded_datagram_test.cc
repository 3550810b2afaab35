// Datagrams that a real MVN sent. They are not part of this repository: see tests/shared_data.h.
#include <gtest/gtest.h>

#include "server/mvn/assembler.h"
#include "server/mvn/byte_order.h"
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

TEST(RecordedDatagram, PoseHasTheCounterTimeCodeAndPelvisOfItsBytes) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  const Message message = Recorded("udp/mxtp02.bin");
  EXPECT_EQ(message.header.sample_counter, 6681U);
  EXPECT_EQ(message.header.time_code_millis, 27837U);
  EXPECT_EQ(message.header.body_segments, 23);
  const auto& pose = std::get<PoseMessage>(message.body);
  EXPECT_TRUE(pose.present.all());
  EXPECT_EQ(pose.skipped, 0);
  const PoseItem& pelvis = pose.items[urdf::kPelvis];
  EXPECT_NEAR(pelvis.position.x(), 0.068977, 1e-6);
  EXPECT_NEAR(pelvis.position.y(), 0.410732, 1e-6);
  EXPECT_NEAR(pelvis.position.z(), 1.048348, 1e-6);
  EXPECT_NEAR(pelvis.orientation.w(), 0.988978, 1e-6);
  EXPECT_NEAR(pelvis.orientation.z(), -0.128796, 1e-6);
}

TEST(RecordedDatagram, EulerPoseIsIgnoredAndIsTheSamePelvisInCentimetresAndYUp) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp01.bin");
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  EXPECT_TRUE(std::holds_alternative<NotNeeded>(Recorded("udp/mxtp01.bin").body));
  const std::string bytes = ReadFile(SharedData("udp/mxtp01.bin"));
  ByteReader in(bytes);
  ASSERT_TRUE(in.Seek(kHeaderBytes + 4));
  Eigen::Vector3d yup_cm;
  for (double& value : yup_cm) ASSERT_TRUE(in.ReadFloat(value));
  const Eigen::Vector3d zup_m = Eigen::Vector3d(yup_cm.z(), yup_cm.x(), yup_cm.y()) / 100;
  const Message pose = Recorded("udp/mxtp02.bin");
  const auto& pelvis = std::get<PoseMessage>(pose.body).items[urdf::kPelvis];
  EXPECT_LT((zup_m - pelvis.position).norm(), 1e-6);
}

TEST(RecordedDatagram, MetaDataHasNameAndColour) {
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

TEST(RecordedDatagram, ScaleDataIsTheTPose) {
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

TEST(RecordedDatagram, PoseTurnsTheTPoseOntoItsOwnPositions) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp02.bin");
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp13.bin");
  const Message pose_message = Recorded("udp/mxtp02.bin");
  const Message scale_message = Recorded("udp/mxtp13.bin");
  const auto& pose = std::get<PoseMessage>(pose_message.body);
  const auto& scale = std::get<ScaleMessage>(scale_message.body);
  ASSERT_EQ(scale.segments.size(), 23U);
  for (std::size_t i = 1; i < pose.items.size(); ++i) {
    const auto parent = static_cast<std::size_t>(urdf::kSegments[i].parent);
    const Eigen::Vector3d bone =
        scale.segments[i].origin_in_world - scale.segments[parent].origin_in_world;
    const Eigen::Vector3d chained =
        pose.items[parent].position + pose.items[parent].orientation * bone;
    const double tolerance = i == urdf::kL5 ? 0.013 : 0.003;  // MVN's segments are not quite rigid
    EXPECT_LT((chained - pose.items[i].position).norm(), tolerance) << urdf::kSegments[i].mvn_name;
  }
}

TEST(RecordedDatagram, MakesASampleACharacterAndASkeleton) {
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
  EXPECT_EQ(assembler.counters().ignored.at("type 01"), 1U);
  EXPECT_TRUE(assembler.counters().rejected.empty());
}

TEST(RecordedDatagram, HundredAndFiftyTrackersAreIgnoredAndCounted) {
  KINESCOPE_NEEDS_SHARED_DATA("udp/mxtp23_lowerbody_000-149.bin");
  const std::string all = ReadFile(SharedData("udp/mxtp23_lowerbody_000-149.bin"));
  constexpr std::size_t kDatagramBytes = 500;
  ASSERT_EQ(all.size(), 150 * kDatagramBytes);
  Assembler assembler;
  RecordingSink sink;
  for (std::size_t at = 0; at < all.size(); at += kDatagramBytes) {
    const auto now = static_cast<std::int64_t>(at);
    assembler.Add({}, std::string_view(all).substr(at, kDatagramBytes), {now, now}, sink);
  }
  EXPECT_EQ(assembler.counters().ignored.at("type 23"), 150U);
  EXPECT_EQ(assembler.counters().datagrams, 150U);
  EXPECT_TRUE(assembler.counters().rejected.empty());
  EXPECT_TRUE(sink.samples.empty());
}

}  // namespace
}  // namespace kinescope::mvn
