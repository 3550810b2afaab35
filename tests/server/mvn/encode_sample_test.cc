#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "server/mvn/assembler.h"
#include "server/mvn/encode.h"
#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using ::testing::ElementsAre;
using testing::RandomValues;

// Everything that a sample can have: all messages, gloves, props.
BodySample FullSample(RandomValues& random) {
  BodySample sample = testing::RandomSample(random, 1200);
  sample.fingers_and_props.present.set();
  for (urdf::Pose& pose : sample.fingers_and_props.poses) pose = {random.Vector(2), random.Turn()};
  sample.utc_millis_of_day = 57'586'065;
  return sample;
}

TypeSet AllTypes() { return TypeSet().set(); }

std::vector<std::pair<std::string, std::size_t>> Sizes(const std::vector<std::string>& datagrams) {
  std::vector<std::pair<std::string, std::size_t>> sizes;
  for (const std::string& datagram : datagrams) {
    sizes.emplace_back(datagram.substr(4, 2), datagram.size());
  }
  return sizes;
}
using P = std::pair<std::string, std::size_t>;

// The points of type 13, in the order in which they are sent.
std::vector<ScalePoint> SentPoints(const std::vector<std::string>& datagrams) {
  std::vector<ScalePoint> points;
  for (const std::string& datagram : datagrams) {
    const auto message = ParseDatagram(datagram);
    const auto* const scale = std::get_if<ScaleMessage>(&message->body);
    if (scale != nullptr) points.insert(points.end(), scale->points.begin(), scale->points.end());
  }
  return points;
}

// mvn-protocol.md 3: "Sizes".
TEST(EncodeSample, WritesTheDatagramsOfASampleInTheSizesOfACurrentMvn) {
  RandomValues random(3);
  const BodySample sample = testing::RandomSample(random, 1);
  EXPECT_THAT(Sizes(EncodeSample(sample)),
              ElementsAre(P("02", 760), P("20", 464), P("21", 944), P("22", 1036), P("24", 60)));
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  const std::size_t markers = kHeaderBytes + 16 * urdf::LandmarksOf(skeleton).size();
  EXPECT_THAT(Sizes(EncodeSample(sample, AllTypes(), urdf::LandmarksOf(skeleton))),
              ElementsAre(P("01", 668), P("02", 760), P("03", markers), P("20", 464), P("21", 944),
                          P("22", 1036), P("23", 1180), P("24", 60), P("25", 40)));
}

TEST(EncodeSample, WritesGlovesAndPropsInTheSizesOfACurrentMvn) {
  RandomValues random(3);
  BodySample sample = FullSample(random);
  const TypeSet poses = MakeTypeSet({Type::kEulerPose, Type::kPose});
  EXPECT_THAT(Sizes(EncodeSample(sample, poses)), ElementsAre(P("01", 1900), P("02", 2168)));
  for (int prop = 0; prop < kMaxProps; ++prop) {
    sample.fingers_and_props.present.reset(static_cast<std::size_t>(PropIndex(prop)));
  }
  EXPECT_THAT(Sizes(EncodeSample(sample, poses)), ElementsAre(P("01", 1788), P("02", 2040)));
}

TEST(EncodeSample, NumbersFingersAfterTheExistingProps) {
  RandomValues random(3);
  BodySample sample = FullSample(random);
  sample.fingers_and_props.present.reset(static_cast<std::size_t>(PropIndex(2)));
  sample.fingers_and_props.present.reset(static_cast<std::size_t>(PropIndex(3)));
  const std::string pose = EncodeSample(sample)[0];
  EXPECT_EQ(pose.substr(17, 3), testing::FromHex("17 02 28")) << "23 segments, 2 props, 40 fingers";
  std::vector<int> ids;
  for (std::size_t at = kHeaderBytes; at < pose.size(); at += 32) {
    ids.push_back(static_cast<unsigned char>(pose[at + 3]));
  }
  ASSERT_EQ(ids.size(), 65U);
  for (std::size_t i = 0; i < ids.size(); ++i) EXPECT_EQ(ids[i], static_cast<int>(i) + 1);
}

TEST(EncodeSample, WritesTheNumbersOfSegmentsIntoEveryDatagram) {
  RandomValues random(3);
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  for (const std::string& datagram :
       EncodeSample(FullSample(random), AllTypes(), urdf::LandmarksOf(skeleton))) {
    EXPECT_EQ(datagram.substr(17, 3), testing::FromHex("17 04 28")) << datagram.substr(4, 2);
  }
}

TEST(EncodeSample, OmitsDataThatTheSampleDoesNotContain) {
  BodySample sample;
  EXPECT_EQ(EncodeSample(sample).size(), 1U);
  EXPECT_THAT(Sizes(EncodeSample(sample, AllTypes())),
              ElementsAre(P("01", 668), P("02", 760), P("25", 40)));
  sample.com = CenterOfMass();
  const auto datagrams = EncodeSample(sample);
  ASSERT_EQ(datagrams.size(), 2U);
  EXPECT_EQ(datagrams[1].size(), 36U) << "without derivatives the centre of mass is 12 bytes";
}

TEST(EncodeSample, OmitsTypesThatAreNotRequested) {
  RandomValues random(3);
  const auto datagrams =
      EncodeSample(FullSample(random), MakeTypeSet({Type::kLinear, Type::kTimeCode}));
  EXPECT_THAT(Sizes(datagrams), ElementsAre(P("21", 944), P("25", 40)));
}

TEST(EncodeSample, WritesTheHeaderOfACurrentMvn) {
  BodySample sample;
  sample.counter = 0x01020304;
  sample.time_code_millis = 0x0a0b0c0d;
  sample.character = 5;
  // Alone in its sample, 23 items, 23 segments, no props or fingers, 23 * 32 bytes.
  EXPECT_EQ(EncodeSample(sample)[0].substr(0, 24),
            testing::FromHex("4d5854503032 01020304 80 17 0a0b0c0d 05 17 00 00 0000 02e0"));
}

template <class Content>
Content ParseOnly(const std::vector<std::string>& datagrams) {
  EXPECT_EQ(datagrams.size(), 1U);
  return std::get<Content>(ParseDatagram(datagrams.at(0)).value().body);
}

TEST(EncodeSample, WritesTheTrackersOfTheSample) {
  RandomValues random(3);
  BodySample sample = testing::RandomSample(random, 1);
  sample.has_tracker.set(urdf::kT8);
  sample.trackers[urdf::kT8].magnetic_field = {0.5, 0.25, -0.75};
  const auto body =
      ParseOnly<TrackersMessage>(EncodeSample(sample, MakeTypeSet({Type::kTrackers})));
  EXPECT_EQ(body.present, sample.has_tracker);
  EXPECT_EQ(body.trackers[urdf::kT8].magnetic_field, sample.trackers[urdf::kT8].magnetic_field);
}

// The T8 leans 90 degrees forward: its z axis points along the world's x.
TEST(EncodeSample, ComputesGravityRatesAndMagneticFieldInTheAxesOfTheTrackers) {
  BodySample sample;
  sample.has_linear = sample.has_angular = true;
  SegmentState& t8 = sample.segments[urdf::kT8];
  t8.orientation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitY());
  t8.acceleration = {2, 0, 0};
  t8.angular_velocity = {0, 3, 0};
  const auto body =
      ParseOnly<TrackersMessage>(EncodeSample(sample, MakeTypeSet({Type::kTrackers})));
  EXPECT_EQ(body.present.count(), 17U);
  const TrackerState& leaning = body.trackers[urdf::kT8];
  const TrackerState& upright = body.trackers[urdf::kHead];
  EXPECT_TRUE(leaning.has_rates);
  EXPECT_EQ(leaning.free_acceleration, t8.acceleration);
  EXPECT_LT((leaning.acceleration - Eigen::Vector3d(-9.81, 0, 2)).norm(), 1e-5);
  EXPECT_LT((leaning.angular_velocity - Eigen::Vector3d(0, 3, 0)).norm(), 1e-6);
  EXPECT_LT((upright.acceleration - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-5);
  EXPECT_NEAR(upright.magnetic_field.norm(), 1, 1e-6);
  EXPECT_LT((t8.orientation * leaning.magnetic_field - upright.magnetic_field).norm(), 1e-6)
      << "one field for all";
}

TEST(EncodeSample, WritesMarkersAtTheirSegmentsWithTheIdsOfTheScaleData) {
  BodySample sample;
  SegmentState& head = sample.segments[urdf::kHead];
  head.position = {1, 2, 3};
  head.orientation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitX());
  const urdf::Skeleton skeleton = urdf::DefaultSkeleton();
  Character character;
  character.skeleton = skeleton;
  character.landmarks = urdf::LandmarksOf(skeleton);
  const auto body = ParseOnly<MarkersMessage>(
      EncodeSample(sample, MakeTypeSet({Type::kMarkers}), LandmarksToSend(character)));
  const auto points = SentPoints(EncodeCharacter(character));
  ASSERT_EQ(static_cast<std::size_t>(body.count), points.size());
  bool found = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(body.markers[i].segment_id, static_cast<std::uint32_t>(points[i].segment_id));
    EXPECT_EQ(body.markers[i].point_id, static_cast<std::uint32_t>(points[i].point_id));
    if (points[i].name != "pTopOfHead") continue;
    found = true;
    const Eigen::Vector3d expected = head.position + head.orientation * skeleton.head_top_in_head;
    EXPECT_LT((body.markers[i].position - expected).norm(), 1e-5);
  }
  EXPECT_TRUE(found);
}

TEST(EncodeSample, UsesTheTimeStampAsTimeOfDayIfNoneWasSent) {
  BodySample sample;
  sample.stamp_nanos = 1'577'836'800'000'000'000 + 3'723'004'900'000;  // 2020-01-01, 01:02:03.0049
  const TypeSet time_code = MakeTypeSet({Type::kTimeCode});
  EXPECT_EQ(EncodeSample(sample, time_code)[0].substr(28), "01:02:03.004");
  sample.utc_millis_of_day = 57'586'065;
  EXPECT_EQ(EncodeSample(sample, time_code)[0].substr(28), "15:59:46.065");
}

TEST(EncodeSample, WritesObjectsAsACharacterOfAsManySegments) {
  ObjectsSample sample;
  sample.character = 3;
  sample.counter = 7;
  sample.present.set(0).set(2);
  sample.poses[2] = {{1, 2, 0.5}, Eigen::Quaterniond(0, 1, 0, 0)};
  const auto datagrams = EncodeObjects(sample);
  const auto message = ParseDatagram(datagrams.at(0)).value();
  EXPECT_EQ(message.header.body_segments, 3);
  EXPECT_EQ(message.header.character, 3);
  EXPECT_EQ(message.header.sample_counter, 7U);
  const auto& body = std::get<PoseMessage>(message.body);
  EXPECT_EQ(body.present.to_ullong(), 0b101U);
  EXPECT_EQ(body.items[2].position, sample.poses[2].position);

  Character objects;
  objects.id = 3;
  objects.scaled_segments = {{"Box", {0, 0, 0}}, {"Trolley", {1, 0, 0}}};
  const auto described = EncodeCharacter(objects);
  ASSERT_EQ(described.size(), 2U);
  const auto scale = ParseDatagram(described[1]).value();
  EXPECT_EQ(scale.header.body_segments, 2);
  EXPECT_TRUE(scale.header.is_last_part);
  const auto& segments = std::get<ScaleMessage>(scale.body).segments;
  ASSERT_EQ(segments.size(), 2U);
  EXPECT_EQ(segments[1].name, "Trolley");
  EXPECT_EQ(segments[1].origin_in_world, Eigen::Vector3d(1, 0, 0));
}

TEST(EncodeSample, SplitsScaleDataIntoSegmentsAndPoints) {
  Character character;
  character.id = 2;
  character.name = "Ines\nname:Eve";
  character.skeleton = urdf::DefaultSkeleton();
  character.landmarks = urdf::LandmarksOf(*character.skeleton);
  const auto datagrams = EncodeCharacter(character);
  ASSERT_EQ(datagrams.size(), 4U);
  EXPECT_EQ(datagrams[0].substr(10, 2), testing::FromHex("80 01"));
  EXPECT_EQ(datagrams[1].substr(10, 2), testing::FromHex("00 00"));
  EXPECT_EQ(datagrams[2].substr(10, 2), testing::FromHex("01 00"));
  EXPECT_EQ(datagrams[3].substr(10, 2), testing::FromHex("82 00"));
  const auto meta = ParseDatagram(datagrams[0]);
  EXPECT_EQ(std::get<MetaDataMessage>(meta->body).name, "Ines?name:Eve")
      << "a line break in a name must not make a tag of its own";
  std::set<std::string> names;
  std::set<std::pair<int, int>> ids;
  for (const ScalePoint& point : SentPoints(datagrams)) {
    names.insert(point.name);
    EXPECT_TRUE(ids.emplace(point.segment_id, point.point_id).second) << "twice: " << point.name;
  }
  for (const char* name :
       {"pHipOrigin", "jL5S1", "jLeftBallFoot", "pTopOfHead", "pRightTopOfHand", "pLeftTopOfHand",
        "pRightHeelFoot", "pLeftHeelFoot", "pRightToe", "pLeftToe"}) {
    EXPECT_EQ(names.count(name), 1U) << name;
  }
}

TEST(EncodeSample, SendsNoEndPointsThatNobodyMeasured) {
  Character character;
  character.skeleton = urdf::SkeletonFromTPose(TPoseOrigins(urdf::DefaultSkeleton()), {});
  std::size_t joints = 0;
  for (const ScalePoint& point : SentPoints(EncodeCharacter(character))) {
    EXPECT_TRUE(point.name[0] == 'j' || point.name == "pHipOrigin") << point.name;
    ++joints;
  }
  EXPECT_EQ(joints, 1U + 2 * urdf::kJointCount);
}

TEST(EncodeSample, SendsAllLandmarksThatWereReadAndTheyAreReceivedAgain) {
  Character character;
  character.skeleton = urdf::DefaultSkeleton();
  character.landmarks = urdf::LandmarksOf(*character.skeleton);
  for (int i = 0; character.landmarks.size() < urdf::kMaxLandmarks; ++i) {
    character.landmarks.push_back(
        {i % urdf::kSegmentCount, 20 + i, "pOther" + std::to_string(i), {0.25, 0, -0.125}, 3});
  }
  Assembler assembler;
  testing::RecordingSink sink;
  for (const std::string& datagram : EncodeCharacter(character)) {
    assembler.Add({}, datagram, {1, 1}, sink);
  }
  BodySample sample;
  for (const std::string& datagram : EncodeSample(sample)) {
    assembler.Add({}, datagram, {1, 1}, sink);
  }
  assembler.Flush(sink);
  ASSERT_EQ(sink.characters.size(), 1U);
  const urdf::Landmarks& received = sink.characters[0].landmarks;
  ASSERT_EQ(received.size(), character.landmarks.size());
  for (std::size_t i = 0; i < received.size(); ++i) {
    EXPECT_EQ(received[i].name, character.landmarks[i].name);
    EXPECT_EQ(received[i].number, character.landmarks[i].number);
    EXPECT_EQ(received[i].segment, character.landmarks[i].segment);
    EXPECT_EQ(received[i].flags, character.landmarks[i].flags);
    EXPECT_LT((received[i].in_segment - character.landmarks[i].in_segment).norm(), 1e-7);
  }
  const auto markers = ParseOnly<MarkersMessage>(
      EncodeSample(sample, MakeTypeSet({Type::kMarkers}), character.landmarks));
  EXPECT_EQ(markers.count, 255);
}

TEST(EncodeSample, WritesNamesOfPropsAndFingersAfterTheBody) {
  Character character;
  character.skeleton = urdf::DefaultSkeleton();
  character.scaled_segments.resize(kFingerAndPropCount);
  character.scaled_segments[0] = {"Prop1Sword", {0.25, 0, 1}};
  for (std::size_t i = kMaxProps; i < kFingerAndPropCount; ++i) {
    character.scaled_segments[i].name = FingerOrPropName(static_cast<int>(i));
  }
  const auto datagrams = EncodeCharacter(character);
  for (const std::string& datagram : datagrams) {
    EXPECT_EQ(datagram.substr(17, 3), testing::FromHex("17 01 28"));
  }
  const auto scale = ParseDatagram(datagrams[1]);
  const auto& segments = std::get<ScaleMessage>(scale->body).segments;
  ASSERT_EQ(segments.size(), 23U + 1 + 40);
  EXPECT_EQ(segments[22].name, "LeftToe");
  EXPECT_EQ(segments[23].name, "Prop1Sword");
  EXPECT_EQ(segments[23].origin_in_world, character.scaled_segments[0].origin_in_world);
  EXPECT_EQ(segments[24].name, "LeftCarpus");
  EXPECT_EQ(segments[44].name, "RightCarpus");
}

TEST(EncodeSample, PutsTheTPoseOnTheFloorWithArmsSideways) {
  const auto origins = TPoseOrigins(urdf::DefaultSkeleton());
  EXPECT_LT(origins[urdf::kRightHand].y(), -0.6);
  EXPECT_GT(origins[urdf::kLeftHand].y(), 0.6);
  EXPECT_NEAR(origins[urdf::kRightHand].z(), origins[urdf::kRightUpperArm].z(), 1e-9);
  EXPECT_NEAR(origins[urdf::kRightFoot].z(), 0.08, 1e-9) << "the ankle of the default body";
}

}  // namespace
}  // namespace kinescope::mvn
