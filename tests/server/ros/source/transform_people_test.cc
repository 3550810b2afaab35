// What happens to people's frames once they are in the program, without a graph around it.
#include "server/ros/source/transform_people.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "core/system/clocks.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/source/written_bag.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::MakeModel;
using testing::MakePerson;
using ::testing::Pair;
using testing::Posture;
using ::testing::UnorderedElementsAre;

constexpr std::int64_t kTransformsStart = 1'700'000'000'000 * kNanosPerMilli;
constexpr std::int64_t kSettle = 250 * kNanosPerMilli;
constexpr std::int64_t kTransformsPeriod = 10 * kNanosPerMilli;

tf2_msgs::TFMessage FrameAtOrigin(const std::string& parent, const std::string& child) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  message.transforms[0].header.frame_id = parent;
  message.transforms[0].child_frame_id = child;
  message.transforms[0].transform.rotation.w = 1;
  return message;
}

class TransformPeopleTest : public ::testing::Test {
 protected:
  PersonState PersonAt(int n, double height_m = 1.75) const {
    return MakePerson(MakeModel("skeleton", height_m), Posture(0.002 * n),
                      static_cast<std::uint32_t>(n), kTransformsStart + n * kTransformsPeriod);
  }

  // The n-th message, 3 ms after its stamp.
  void Take(int n, const tf2_msgs::TFMessage& message) {
    const std::int64_t now = kTransformsStart + n * kTransformsPeriod + 3 * kNanosPerMilli;
    people_.Take(message, {now, 1 + n * kTransformsPeriod}, counters_, sink_);
  }

  // Somebody stands there already: the next samples come at once.
  void Settle() {
    int n = -30;
    for (; sink_.samples.empty() && n < 0; ++n) Take(n, TransformsOf(PersonAt(n)));
    ASSERT_FALSE(sink_.samples.empty());
    EXPECT_EQ(sink_.samples[0].stamp_nanos, kTransformsStart - 5 * kTransformsPeriod)
        << "a quarter of a second after -300 ms";
    sink_.samples.clear();
    counters_ = {};
  }

  TransformPeople people_{kSettle};
  SourceCounters counters_;
  kinescope::testing::RecordingSink sink_;
};

// Of tags, or of people who come and go: nobody was found as long as they did.
TEST_F(TransformPeopleTest, FindsPeopleThoughNewNamesComeAllTheTime) {
  for (int n = 0; n < 120; ++n) {
    Take(n, FrameAtOrigin("world", "x" + std::to_string(n) + "_pelvis"));
    Take(n, TransformsOf(PersonAt(n)));
  }
  EXPECT_GE(sink_.samples.size(), 15u);
}

TEST_F(TransformPeopleTest, ReturnsThePublishedPosesWhenAllNamesAreKnown) {
  Settle();
  for (int n = 0; n < 20; ++n) {
    const PersonState person = PersonAt(n);
    Take(n, TransformsOf(person, n % 2 == 0 ? TfShape::kFlat : TfShape::kTree));
    ASSERT_EQ(sink_.samples.size(), static_cast<std::size_t>(n) + 1);
    const BodySample& sample = sink_.samples.back();
    EXPECT_EQ(sample.stamp_nanos, kTransformsStart + n * kTransformsPeriod);
    EXPECT_EQ(sample.arrival_nanos, 1 + n * kTransformsPeriod);
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      const SegmentState& sent = person.sample.segments[At(segment)];
      const SegmentState& got = sample.segments[At(segment)];
      EXPECT_LT((got.position - sent.position).norm(), 1e-12);
      EXPECT_LT(got.orientation.angularDistance(sent.orientation), 1e-7);
    }
  }
  EXPECT_THAT(sink_.characters, ::testing::SizeIs(1));
  EXPECT_THAT(counters_.rejected, IsEmpty());
}

// As when a bag is played in a loop with its clock.
TEST_F(TransformPeopleTest, BeginsAnewWhenTheClockOfTheGraphWasSetBack) {
  Settle();
  for (int n = 0; n < 20; ++n) Take(n, TransformsOf(PersonAt(n)));
  for (int n = 2; n < 10; ++n) Take(n, TransformsOf(PersonAt(n)));
  ASSERT_EQ(sink_.samples.size(), 28U);
  EXPECT_EQ(counters_.restarts, 1U);
  EXPECT_THAT(counters_.rejected, IsEmpty());
  for (std::size_t i = 20; i < 28; ++i) {
    const std::int64_t n = static_cast<std::int64_t>(i) - 18;
    EXPECT_EQ(sink_.samples[i].stamp_nanos, kTransformsStart + n * kTransformsPeriod)
        << "the stamp in its headers";
    EXPECT_GE(sink_.samples[i].time_code_millis, sink_.samples[i - 1].time_code_millis);
    EXPECT_EQ(sink_.samples[i].counter, sink_.samples[i - 1].counter + 1);
  }
}

// Such as those of a suit that counts the seconds of the day: they are not taken then either.
TEST_F(TransformPeopleTest, BeginsAnewAlsoWithHeadersOfAnotherTime) {
  const auto take = [&](int n) {
    tf2_msgs::TFMessage message = TransformsOf(PersonAt(n));
    for (auto& transform : message.transforms) {
      transform.header.stamp -= ros::Duration(1'500'000'000);
    }
    Take(n, message);
  };
  for (int n = -30; n < 20; ++n) take(n);
  const std::size_t before = sink_.samples.size();
  ASSERT_GT(before, 20U);
  for (int n = 2; n < 10; ++n) take(n);
  ASSERT_EQ(sink_.samples.size(), before + 8);
  EXPECT_EQ(counters_.restarts, 1U);
  for (std::size_t i = 1; i < sink_.samples.size(); ++i) {
    const auto step = sink_.samples[i].time_code_millis - sink_.samples[i - 1].time_code_millis;
    EXPECT_GE(step, 0) << i;
    EXPECT_LE(step, 100) << i;
  }
}

// Names come one by one; a robot's "head" must not stand in for one that is still under way.
TEST_F(TransformPeopleTest, DoesNotUseTheHeadOfARobotForAPerson) {
  for (const char* frame : {"head", "pelvis", "left_hand", "right_hand"}) {
    Take(0, FrameAtOrigin("base", frame));
  }
  tf2_msgs::TFMessage suit;
  for (const urdf::SegmentInfo& segment : urdf::kSegments) {
    const auto one = FrameAtOrigin("body_sensor", std::string(segment.link_name) + "_xsens");
    suit.transforms.push_back(one.transforms[0]);
  }
  tf2_msgs::TFMessage most = suit;
  most.transforms.erase(most.transforms.begin() + urdf::kHead);
  for (int n = 0; n < 10; ++n) Take(n, most);
  EXPECT_THAT(people_.people(), IsEmpty());
  Take(10, suit);
  for (int n = 11; n < 60 && sink_.samples.empty(); ++n) Take(n, suit);
  ASSERT_EQ(people_.people().size(), 1U);
  EXPECT_EQ(people_.people()[0].name, "xsens");
  EXPECT_EQ(people_.people()[0].frames[urdf::kHead], "head_xsens");
}

TEST_F(TransformPeopleTest, IncludesFramesOfTfStaticInEverySample) {
  const auto is_fixed = [](const std::string& child) {
    return child == "skeleton_left_toe" || child == "skeleton_left_ballfoot_x_link";
  };
  const PersonState person = PersonAt(0);
  tf2_msgs::TFMessage fixed;
  for (const auto& transform : TransformsOf(person, TfShape::kTree).transforms) {
    if (is_fixed(transform.child_frame_id)) fixed.transforms.push_back(transform);
  }
  ASSERT_EQ(fixed.transforms.size(), 2U);
  people_.TakeStatic(fixed, counters_);  // before anybody is there, as a latched topic does
  for (int n = 0; n < 60; ++n) {
    PersonState now = PersonAt(n);
    now.angles = person.angles;
    now.links = person.links;  // so that what is fixed is
    tf2_msgs::TFMessage moving;
    for (const auto& transform : TransformsOf(now, TfShape::kTree).transforms) {
      if (!is_fixed(transform.child_frame_id)) moving.transforms.push_back(transform);
    }
    Take(n, moving);
  }
  ASSERT_GT(sink_.samples.size(), 30U);
  const SegmentState& toe = sink_.samples.back().segments[urdf::kLeftToe];
  EXPECT_LT((toe.position - person.sample.segments[urdf::kLeftToe].position).norm(), 1e-12);
  EXPECT_THAT(counters_.rejected, IsEmpty());
}

TEST_F(TransformPeopleTest, CountsRejectedTransformsAndContinues) {
  Settle();
  for (int n = 0; n < 7; ++n) {
    PersonState person = PersonAt(n);
    if (n == 5) person.sample.stamp_nanos = kTransformsStart - kTransformsPeriod;  // time goes back
    tf2_msgs::TFMessage message = TransformsOf(person);
    auto& transform = message.transforms[3].transform;
    if (n == 1) transform.translation.y = std::numeric_limits<double>::quiet_NaN();
    if (n == 2) transform.rotation.w += 0.1;
    if (n == 3) message.transforms.erase(message.transforms.begin() + 7);
    if (n == 4) message.transforms[3].header.frame_id = "somewhere_else";
    Take(n, message);
  }
  Take(7, FrameAtOrigin("base", "camera"));
  EXPECT_THAT(
      counters_.rejected,
      UnorderedElementsAre(Pair("transform with a number that is not finite", 1),
                           Pair("transform with a quaternion that is not of unit length", 1),
                           Pair("sample without all 23 segments", 3),
                           Pair("sample whose frames have no common parent", 1)));
  EXPECT_THAT(counters_.ignored, ElementsAre(Pair("message on /tf without a person's segment", 1)));
  EXPECT_EQ(counters_.restarts, 1U);
  ASSERT_EQ(sink_.samples.size(), 3U) << "0, 5 and 6";
  EXPECT_EQ(sink_.samples[1].stamp_nanos,
            kTransformsStart + 5 * kTransformsPeriod + 3 * kNanosPerMilli)
      << "by arrival from now on";
  EXPECT_GT(sink_.samples[2].stamp_nanos, sink_.samples[1].stamp_nanos);
}

// What it left cut each whole message after it in two, and the person stood still for good.
TEST_F(TransformPeopleTest, GoesOnAfterAStrayTransformOfOneSegment) {
  Settle();
  for (int n = 0; n < 10; ++n) {
    Take(n, TransformsOf(PersonAt(n)));
    if (n == 3) Take(n, FrameAtOrigin("world", "skeleton_right_hand"));
    if (n == 6) Take(n, FrameAtOrigin("odom", "skeleton_pelvis"));
  }
  EXPECT_EQ(sink_.samples.size(), 10U);
  EXPECT_THAT(counters_.rejected, ElementsAre(Pair("sample without all 23 segments", 2)));
}

TEST_F(TransformPeopleTest, DetectsAChangeOfPersonAfterASecond) {
  Settle();
  for (int n = 0; n < 300; ++n) Take(n, TransformsOf(PersonAt(n, n < 100 ? 1.75 : 1.95)));
  ASSERT_EQ(sink_.characters.size(), 2U);
  EXPECT_EQ(sink_.characters[0].id, sink_.characters[1].id);
  ASSERT_TRUE(sink_.characters[0].skeleton && sink_.characters[1].skeleton);
  const auto shank = [](const Character& character) {
    return character.skeleton->origin_in_parent[urdf::kLeftFoot].norm();
  };
  EXPECT_NEAR(shank(sink_.characters[1]) / shank(sink_.characters[0]), 1.95 / 1.75, 1e-6);
  EXPECT_EQ(sink_.samples.size(), 300U);
}

}  // namespace
}  // namespace kinescope::ros_bridge
