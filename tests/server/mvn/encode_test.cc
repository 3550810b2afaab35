#include "server/mvn/encode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using testing::RandomValues;

constexpr double kFloatNoise = 1e-6;  // of a quaternion that was rounded to floats, then normalised

template <class Item>
PerSegment<Item> RandomSegments(RandomValues& random, void (*fill)(RandomValues&, Item&)) {
  PerSegment<Item> body;
  for (std::size_t i = 0; i < body.items.size(); ++i) {
    if (i > 0 && random.Coin(0.3)) continue;  // never empty: a body without items is refused
    body.present.set(i);
    fill(random, body.items[i]);
  }
  return body;
}

Message RandomMessage(RandomValues& random, Body body) {
  Message message;
  message.header.sample_counter = static_cast<std::uint32_t>(random.Integer(0, 1 << 30));
  message.header.part = random.Integer(0, 127);
  message.header.is_last_part = random.Coin(0.5);
  message.header.time_code_millis = static_cast<std::uint32_t>(random.Integer(0, 1 << 30));
  message.header.character = random.Integer(0, 255);
  message.header.body_segments = 23;
  message.header.props = random.Integer(0, 4);
  message.header.finger_segments = random.Coin(0.5) ? 40 : 0;
  message.body = std::move(body);
  return message;
}

// The message that comes back; checks the header on the way.
Message ThereAndBack(const Message& message) {
  const std::string datagram = Encode(message);
  const auto back = ParseDatagram(datagram);
  if (!back) {
    ADD_FAILURE() << Describe(back.error());
    return {};
  }
  EXPECT_EQ(back->header.sample_counter, message.header.sample_counter);
  EXPECT_EQ(back->header.part, message.header.part);
  EXPECT_EQ(back->header.is_last_part, message.header.is_last_part);
  EXPECT_EQ(back->header.time_code_millis, message.header.time_code_millis);
  EXPECT_EQ(back->header.character, message.header.character);
  EXPECT_EQ(back->header.props, message.header.props);
  EXPECT_EQ(back->header.finger_segments, message.header.finger_segments);
  EXPECT_EQ(back->header.payload_bytes + kHeaderBytes, datagram.size());
  EXPECT_EQ(back->body.index(), message.body.index());
  return *back;
}

class RoundTrip : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  RandomValues random_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Seeds, RoundTrip, ::testing::Range(1U, 21U));

TEST_P(RoundTrip, KeepsPoses) {
  const auto body = RandomSegments<PoseItem>(random_, [](RandomValues& random, PoseItem& item) {
    item = {random.Vector(10), random.Turn()};
  });
  const auto back = std::get<PoseMessage>(ThereAndBack(RandomMessage(random_, body)).body);
  EXPECT_EQ(back.present, body.present);
  for (std::size_t i = 0; i < body.items.size(); ++i) {
    EXPECT_EQ(back.items[i].position, body.items[i].position);
    EXPECT_LT(back.items[i].orientation.angularDistance(body.items[i].orientation), kFloatNoise);
    EXPECT_NEAR(back.items[i].orientation.norm(), 1.0, 1e-12) << "accepted ones are normalised";
  }
}

TEST_P(RoundTrip, KeepsLinearAndAngularKinematics) {
  const auto linear =
      RandomSegments<LinearItem>(random_, [](RandomValues& random, LinearItem& item) {
        item = {random.Vector(10), random.Vector(5), random.Vector(100)};
      });
  const auto linear_back =
      std::get<LinearMessage>(ThereAndBack(RandomMessage(random_, linear)).body);
  const auto angular =
      RandomSegments<AngularItem>(random_, [](RandomValues& random, AngularItem& item) {
        item = {random.Turn(), random.Vector(20), random.Vector(500)};
      });
  const auto angular_back =
      std::get<AngularMessage>(ThereAndBack(RandomMessage(random_, angular)).body);
  EXPECT_EQ(linear_back.present, linear.present);
  EXPECT_EQ(angular_back.present, angular.present);
  for (std::size_t i = 0; i < linear.items.size(); ++i) {
    EXPECT_EQ(linear_back.items[i].position, linear.items[i].position);
    EXPECT_EQ(linear_back.items[i].velocity, linear.items[i].velocity);
    EXPECT_EQ(linear_back.items[i].acceleration, linear.items[i].acceleration);
    EXPECT_LT(angular_back.items[i].orientation.angularDistance(angular.items[i].orientation),
              kFloatNoise);
    EXPECT_EQ(angular_back.items[i].velocity, angular.items[i].velocity);
    EXPECT_EQ(angular_back.items[i].acceleration, angular.items[i].acceleration);
  }
}

TEST_P(RoundTrip, KeepsJointAnglesAndCentreOfMass) {
  JointAnglesMessage angles;
  for (std::size_t i = 0; i < angles.joints.size(); ++i) {
    if (i > 0 && random_.Coin(0.2)) continue;
    angles.joints_present.set(i);
    angles.joints[i] = random_.Vector(180);
  }
  const auto angles_back =
      std::get<JointAnglesMessage>(ThereAndBack(RandomMessage(random_, angles)).body);
  EXPECT_EQ(angles_back.joints_present, angles.joints_present);
  EXPECT_EQ(angles_back.joints, angles.joints);

  CenterOfMassMessage com;
  com.position = random_.Vector(5);
  com.has_derivatives = random_.Coin(0.5);
  if (com.has_derivatives) com.velocity = random_.Vector(5);
  const auto com_back =
      std::get<CenterOfMassMessage>(ThereAndBack(RandomMessage(random_, com)).body);
  EXPECT_EQ(com_back.position, com.position);
  EXPECT_EQ(com_back.velocity, com.velocity);
  EXPECT_EQ(com_back.has_derivatives, com.has_derivatives);
}

TEST_P(RoundTrip, KeepsMetaAndScaleData) {
  MetaDataMessage meta;
  if (random_.Coin(0.7)) meta.name = "person " + std::to_string(random_.Integer(0, 1000));
  if (random_.Coin(0.7)) meta.color_rgb = static_cast<std::uint32_t>(random_.Integer(0, 0xFFFFFF));
  const auto meta_back = std::get<MetaDataMessage>(ThereAndBack(RandomMessage(random_, meta)).body);
  EXPECT_EQ(meta_back.name, meta.name);
  EXPECT_EQ(meta_back.color_rgb, meta.color_rgb);

  ScaleMessage scale;
  for (int i = random_.Integer(0, 30); i > 0; --i) {
    scale.segments.push_back({"segment " + std::to_string(i), random_.Vector(2)});
  }
  for (int i = random_.Integer(0, 30); i > 0; --i) {
    scale.points.push_back({random_.Integer(1, 63), random_.Integer(0, 20),
                            "point " + std::to_string(i), 8U, random_.Vector(0.5)});
  }
  const auto back = std::get<ScaleMessage>(ThereAndBack(RandomMessage(random_, scale)).body);
  ASSERT_EQ(back.segments.size(), scale.segments.size());
  ASSERT_EQ(back.points.size(), scale.points.size());
  for (std::size_t i = 0; i < scale.segments.size(); ++i) {
    EXPECT_EQ(back.segments[i].name, scale.segments[i].name);
    EXPECT_EQ(back.segments[i].origin_in_world, scale.segments[i].origin_in_world);
  }
  for (std::size_t i = 0; i < scale.points.size(); ++i) {
    EXPECT_EQ(back.points[i].name, scale.points[i].name);
    EXPECT_EQ(back.points[i].segment_id, scale.points[i].segment_id);
    EXPECT_EQ(back.points[i].point_id, scale.points[i].point_id);
    EXPECT_EQ(back.points[i].flags, scale.points[i].flags);
    EXPECT_EQ(back.points[i].offset, scale.points[i].offset);
  }
}

TEST(Encode, SendsASampleInTheSizesThatMvnHas) {
  RandomValues random(3);
  const BodySample sample = testing::RandomSample(random, 1);
  std::vector<std::pair<std::string, std::size_t>> sizes;
  for (const std::string& datagram : EncodeSample(sample)) {
    sizes.emplace_back(datagram.substr(4, 2), datagram.size());
  }
  using P = std::pair<std::string, std::size_t>;
  EXPECT_THAT(sizes, ::testing::ElementsAre(P("02", 760), P("20", 464), P("21", 944), P("22", 1036),
                                            P("24", 60)));
}

TEST(Encode, LeavesOutWhatASampleDoesNotHave) {
  BodySample sample;
  EXPECT_EQ(EncodeSample(sample).size(), 1U);
  sample.com = CenterOfMass();
  const auto datagrams = EncodeSample(sample);
  ASSERT_EQ(datagrams.size(), 2U);
  EXPECT_EQ(datagrams[1].size(), 36U) << "without derivatives the centre of mass is 12 bytes";
}

TEST(Encode, WritesTheHeaderOfACurrentMvn) {
  BodySample sample;
  sample.counter = 0x01020304;
  sample.time_code_millis = 0x0a0b0c0d;
  sample.character = 5;
  // Alone in its sample, 23 items, 23 segments, no props or fingers, 23 * 32 bytes.
  EXPECT_EQ(EncodeSample(sample)[0].substr(0, 24),
            testing::FromHex("4d5854503032 01020304 80 17 0a0b0c0d 05 17 00 00 0000 02e0"));
}

TEST(Encode, SplitsScaleDataIntoSegmentsAndPoints) {
  Character character;
  character.id = 2;
  character.name = "Ines\nname:Eve";
  character.skeleton = urdf::DefaultSkeleton();
  const auto datagrams = EncodeCharacter(character);
  ASSERT_EQ(datagrams.size(), 3U);
  EXPECT_EQ(datagrams[0].substr(0, 24).substr(10, 2), testing::FromHex("80 01"));
  EXPECT_EQ(datagrams[1].substr(10, 2), testing::FromHex("00 00"));
  EXPECT_EQ(datagrams[2].substr(10, 2), testing::FromHex("81 00"));
  const auto meta = ParseDatagram(datagrams[0]);
  EXPECT_EQ(std::get<MetaDataMessage>(meta->body).name, "Ines?name:Eve")
      << "a line break in a name must not make a tag of its own";
  const auto points = ParseDatagram(datagrams[2]);
  std::vector<std::string> names;
  for (const ScalePoint& point : std::get<ScaleMessage>(points->body).points) {
    names.push_back(point.name);
  }
  EXPECT_THAT(names, ::testing::UnorderedElementsAre("pTopOfHead", "pRightTopOfHand",
                                                     "pLeftTopOfHand", "pRightHeelFoot",
                                                     "pLeftHeelFoot", "pRightToe", "pLeftToe"));
}

TEST(Encode, StandsTheTPoseOnTheFloorWithArmsSideways) {
  const auto origins = TPoseOrigins(urdf::DefaultSkeleton());
  EXPECT_LT(origins[urdf::kRightHand].y(), -0.6);
  EXPECT_GT(origins[urdf::kLeftHand].y(), 0.6);
  EXPECT_NEAR(origins[urdf::kRightHand].z(), origins[urdf::kRightUpperArm].z(), 1e-9);
  EXPECT_NEAR(origins[urdf::kRightFoot].z(), 0.08, 1e-9) << "the ankle of the default body";
}

}  // namespace
}  // namespace kinescope::mvn
