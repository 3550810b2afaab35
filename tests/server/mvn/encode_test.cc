#include "server/mvn/encode.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/server/mvn/mvn_testing.h"

namespace kinescope::mvn {
namespace {

using testing::RandomValues;

constexpr double kFloatNoise = 1e-6;  // of a quaternion that was rounded to floats, then normalised

// Of a length in m that went through centimetres in a float.
double CentimetreNoise(const Eigen::Vector3d& value) { return 2e-7 * (value.norm() + 1e-3); }

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

// Whether a message with `header` may hold an item in `slot`.
bool HasPlace(const Header& header, std::size_t slot) {
  if (slot < urdf::kSegmentCount) return true;
  const std::size_t extra = slot - urdf::kSegmentCount;
  return extra < kMaxProps ? extra < static_cast<std::size_t>(header.props)
                           : header.finger_segments > 0;
}

// Body, props and fingers as the header announces them; all of them, or each with a chance.
template <class Segments, class Item>
Message RandomSegments(RandomValues& random, void (*fill)(RandomValues&, Item&)) {
  Message message = RandomMessage(random, Segments());
  auto& body = std::get<Segments>(message.body);
  const double missing = random.Coin(0.5) ? 0 : 0.3;
  for (std::size_t i = 0; i < body.items.size(); ++i) {
    if (!HasPlace(message.header, i)) continue;
    if (i > 0 && random.Coin(missing)) continue;  // never empty: a body without items is refused
    body.present.set(i);
    fill(random, body.items[i]);
  }
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
  EXPECT_EQ(back->header.body_segments, message.header.body_segments);
  EXPECT_EQ(back->header.props, message.header.props);
  EXPECT_EQ(back->header.finger_segments, message.header.finger_segments);
  EXPECT_EQ(back->header.payload_bytes + kHeaderBytes, datagram.size());
  EXPECT_EQ(back->body.index(), message.body.index());
  return *back;
}

// The body of `message` that comes back.
template <class Content>
Content BodyBack(const Message& message) {
  return std::get<Content>(ThereAndBack(message).body);
}

class RoundTrip : public ::testing::TestWithParam<std::uint32_t> {
 protected:
  RandomValues random_{GetParam()};
};
INSTANTIATE_TEST_SUITE_P(Seeds, RoundTrip, ::testing::Range(1U, 41U));

void FillPose(RandomValues& random, PoseItem& item) { item = {random.Vector(10), random.Turn()}; }

TEST_P(RoundTrip, KeepsPosesOfBodyPropsAndFingers) {
  const Message message = RandomSegments<PoseMessage>(random_, &FillPose);
  const auto& body = std::get<PoseMessage>(message.body);
  const auto back = BodyBack<PoseMessage>(message);
  EXPECT_EQ(back.present, body.present);
  EXPECT_EQ(back.skipped, 0);
  EXPECT_EQ(back.mismatched_ids, 0) << "our ids are those of the specification";
  for (std::size_t i = 0; i < body.items.size(); ++i) {
    EXPECT_EQ(back.items[i].position, body.items[i].position);
    EXPECT_LT(back.items[i].orientation.angularDistance(body.items[i].orientation), kFloatNoise);
    EXPECT_NEAR(back.items[i].orientation.norm(), 1.0, 1e-12) << "accepted ones are normalised";
  }
}

TEST_P(RoundTrip, KeepsEulerPosesThroughCentimetresAndYUp) {
  const Message message = RandomSegments<EulerPoseMessage>(random_, &FillPose);
  const auto& body = std::get<EulerPoseMessage>(message.body);
  const auto back = BodyBack<EulerPoseMessage>(message);
  EXPECT_EQ(back.present, body.present);
  for (std::size_t i = 0; i < body.items.size(); ++i) {
    const Eigen::Vector3d& position = body.items[i].position;
    EXPECT_LT((back.items[i].position - position).norm(), CentimetreNoise(position));
    EXPECT_LT(back.items[i].orientation.angularDistance(body.items[i].orientation), kFloatNoise);
  }
}

TEST_P(RoundTrip, KeepsLinearAndAngularKinematics) {
  const Message linear = RandomSegments<LinearMessage, LinearItem>(
      random_, [](RandomValues& random, LinearItem& item) {
        item = {random.Vector(10), random.Vector(5), random.Vector(100)};
      });
  const Message angular = RandomSegments<AngularMessage, AngularItem>(
      random_, [](RandomValues& random, AngularItem& item) {
        item = {random.Turn(), random.Vector(20), random.Vector(500)};
      });
  const auto& linear_sent = std::get<LinearMessage>(linear.body);
  const auto& angular_sent = std::get<AngularMessage>(angular.body);
  const auto linear_back = BodyBack<LinearMessage>(linear);
  const auto angular_back = BodyBack<AngularMessage>(angular);
  EXPECT_EQ(linear_back.present, linear_sent.present);
  EXPECT_EQ(angular_back.present, angular_sent.present);
  for (std::size_t i = 0; i < linear_sent.items.size(); ++i) {
    EXPECT_EQ(linear_back.items[i].position, linear_sent.items[i].position);
    EXPECT_EQ(linear_back.items[i].velocity, linear_sent.items[i].velocity);
    EXPECT_EQ(linear_back.items[i].acceleration, linear_sent.items[i].acceleration);
    EXPECT_LT(angular_back.items[i].orientation.angularDistance(angular_sent.items[i].orientation),
              kFloatNoise);
    EXPECT_EQ(angular_back.items[i].velocity, angular_sent.items[i].velocity);
    EXPECT_EQ(angular_back.items[i].acceleration, angular_sent.items[i].acceleration);
  }
}

TEST_P(RoundTrip, KeepsMarkers) {
  MarkersMessage body;
  body.count = random_.Integer(1, 255);
  for (int i = 0; i < body.count; ++i) {
    body.markers[static_cast<std::size_t>(i)] = {
        static_cast<std::uint32_t>(random_.Integer(1, 67)),
        static_cast<std::uint32_t>(random_.Integer(0, 255)), random_.Vector(10)};
  }
  const auto back = BodyBack<MarkersMessage>(RandomMessage(random_, body));
  ASSERT_EQ(back.count, body.count);
  for (std::size_t i = 0; i < static_cast<std::size_t>(body.count); ++i) {
    EXPECT_EQ(back.markers[i].segment_id, body.markers[i].segment_id);
    EXPECT_EQ(back.markers[i].point_id, body.markers[i].point_id);
    EXPECT_LT((back.markers[i].position - body.markers[i].position).norm(),
              CentimetreNoise(body.markers[i].position));
  }
}

TEST_P(RoundTrip, KeepsTwentyTwoTwentySixOrTwentyEightJoints) {
  JointAnglesMessage body;
  for (Eigen::Vector3d& angles : body.joints) angles = random_.Vector(180);
  for (Eigen::Vector3d& angles : body.ergonomic) angles = random_.Vector(180);
  body.joints_present.set();
  const std::size_t ergonomic = std::array<std::size_t, 3>{0, 4, 6}[GetParam() % 3];
  for (std::size_t i = 0; i < ergonomic; ++i) body.ergonomic_present.set(i);
  const auto back = BodyBack<JointAnglesMessage>(RandomMessage(random_, body));
  EXPECT_EQ(back.joints_present, body.joints_present);
  EXPECT_EQ(back.joints, body.joints);
  EXPECT_EQ(back.ergonomic_present, body.ergonomic_present);
  for (std::size_t i = 0; i < ergonomic; ++i) EXPECT_EQ(back.ergonomic[i], body.ergonomic[i]);
}

TEST_P(RoundTrip, KeepsAnyJointsThatArePresent) {
  JointAnglesMessage body;
  for (std::size_t i = 0; i < body.joints.size(); ++i) {
    if (i > 0 && random_.Coin(0.2)) continue;
    body.joints_present.set(i);
    body.joints[i] = random_.Vector(180);
  }
  const auto back = BodyBack<JointAnglesMessage>(RandomMessage(random_, body));
  EXPECT_EQ(back.joints_present, body.joints_present);
  EXPECT_EQ(back.joints, body.joints);
}

TEST_P(RoundTrip, KeepsTrackersWithAndWithoutRates) {
  for (const bool have_rates : {true, false}) {
    TrackersMessage body;
    for (std::size_t i = 0; i < body.trackers.size(); ++i) {
      if (i > 0 && random_.Coin(0.3)) continue;
      TrackerState& tracker = body.trackers[i];
      body.present.set(i);
      tracker.orientation = random_.Turn();
      tracker.free_acceleration = random_.Vector(50);
      tracker.magnetic_field = random_.Vector(1);
      tracker.has_rates = have_rates;
      if (!have_rates) continue;
      tracker.acceleration = random_.Vector(50);
      tracker.angular_velocity = random_.Vector(20);
    }
    const Message message = RandomMessage(random_, body);
    EXPECT_EQ(Encode(message).size(), kHeaderBytes + body.present.count() * (have_rates ? 68 : 44));
    const auto back = BodyBack<TrackersMessage>(message);
    EXPECT_EQ(back.present, body.present);
    EXPECT_EQ(back.skipped, 0);
    for (std::size_t i = 0; i < body.trackers.size(); ++i) {
      const TrackerState& sent = body.trackers[i];
      const TrackerState& came = back.trackers[i];
      EXPECT_LT(came.orientation.angularDistance(sent.orientation), kFloatNoise);
      EXPECT_EQ(came.free_acceleration, sent.free_acceleration);
      EXPECT_EQ(came.acceleration, sent.acceleration);
      EXPECT_EQ(came.angular_velocity, sent.angular_velocity);
      EXPECT_EQ(came.magnetic_field, sent.magnetic_field);
      EXPECT_EQ(came.has_rates, sent.has_rates);
    }
  }
}

TEST_P(RoundTrip, KeepsCentresOfMassWithAndWithoutDerivatives) {
  for (const bool has_derivatives : {true, false}) {
    CenterOfMassMessage body;
    body.position = random_.Vector(5);
    body.has_derivatives = has_derivatives;
    if (has_derivatives) body.velocity = random_.Vector(5);
    if (has_derivatives) body.acceleration = random_.Vector(50);
    const auto back = BodyBack<CenterOfMassMessage>(RandomMessage(random_, body));
    EXPECT_EQ(back.position, body.position);
    EXPECT_EQ(back.velocity, body.velocity);
    EXPECT_EQ(back.acceleration, body.acceleration);
    EXPECT_EQ(back.has_derivatives, body.has_derivatives);
  }
}

TEST_P(RoundTrip, KeepsTimesOfDay) {
  for (const std::int32_t millis : {0, random_.Integer(0, 86'399'999), 86'399'999}) {
    const Message message = RandomMessage(random_, TimeCodeMessage{millis});
    EXPECT_EQ(Encode(message).size(), kHeaderBytes + 16);
    EXPECT_EQ(BodyBack<TimeCodeMessage>(message).utc_millis_of_day, millis);
  }
}

TEST_P(RoundTrip, KeepsMetaAndScaleData) {
  MetaDataMessage meta;
  if (random_.Coin(0.7)) meta.name = "person " + std::to_string(random_.Integer(0, 1000));
  if (random_.Coin(0.7)) meta.color_rgb = static_cast<std::uint32_t>(random_.Integer(0, 0xFFFFFF));
  const auto meta_back = BodyBack<MetaDataMessage>(RandomMessage(random_, meta));
  EXPECT_EQ(meta_back.name, meta.name);
  EXPECT_EQ(meta_back.color_rgb, meta.color_rgb);

  ScaleMessage scale;
  for (int i = random_.Integer(0, 67); i > 0; --i) {
    scale.segments.push_back({"segment " + std::to_string(i), random_.Vector(2)});
  }
  for (int i = random_.Integer(0, 130); i > 0; --i) {
    scale.points.push_back({random_.Integer(1, 67), random_.Integer(0, 20),
                            "point " + std::to_string(i), 8U, random_.Vector(0.5)});
  }
  const auto back = BodyBack<ScaleMessage>(RandomMessage(random_, scale));
  ASSERT_EQ(back.segments.size(), scale.segments.size());
  ASSERT_EQ(back.points.size(), scale.points.size());
  for (std::size_t i = 0; i < scale.segments.size(); ++i) {
    EXPECT_EQ(back.segments[i].name, scale.segments[i].name);
    EXPECT_EQ(back.segments[i].origin_in_world, scale.segments[i].origin_in_world);
  }
  for (std::size_t i = 0; i < scale.points.size(); ++i) {
    EXPECT_EQ(back.points[i].segment_id, scale.points[i].segment_id);
    EXPECT_EQ(back.points[i].point_id, scale.points[i].point_id);
    EXPECT_EQ(back.points[i].name, scale.points[i].name);
    EXPECT_EQ(back.points[i].flags, scale.points[i].flags);
    EXPECT_EQ(back.points[i].offset, scale.points[i].offset);
  }
}

// Straight up and down, where two of the three angles turn about the same axis.
TEST(Encode, WritesEulerAnglesInGimbalLock) {
  const auto about = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180, axis);
  };
  for (const double pitch : {90.0, -90.0}) {
    for (const double other : {0.0, 35.0, -170.0}) {
      Message message;
      message.header.body_segments = 23;
      EulerPoseMessage body;
      // The stream's y is the world's z.
      body.items[0].orientation = about(other, Eigen::Vector3d::UnitX()) *
                                  about(pitch, Eigen::Vector3d::UnitZ()) *
                                  about(other / 2, Eigen::Vector3d::UnitY());
      body.present.set(0);
      message.body = body;
      const auto back = BodyBack<EulerPoseMessage>(message);
      EXPECT_LT(back.items[0].orientation.angularDistance(body.items[0].orientation), 1e-5)
          << pitch << " " << other;
    }
  }
}

TEST(Encode, ChangesOnlyTheHeader) {
  RandomValues random(3);
  const std::string before = EncodeSample(testing::RandomSample(random, 9))[0];
  std::string after = before;
  PatchHeader({}, after);
  EXPECT_EQ(after, before);
  PatchHeader({17, 0x01020304, 0x0a0b0c0d}, after);
  EXPECT_EQ(after.substr(0, 17), before.substr(0, 6) + testing::FromHex("01020304") +
                                     before.substr(10, 2) + testing::FromHex("0a0b0c0d 11"));
  EXPECT_EQ(after.substr(17), before.substr(17));
}

}  // namespace
}  // namespace kinescope::mvn
