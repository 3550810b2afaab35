#include "server/ros/source/link_states_person.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "server/ros/link_states.h"
#include "tests/recording_sink.h"
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

constexpr std::int64_t kLinksStart = 1'700'000'000'000'000'000;
constexpr std::int64_t kLinksPeriod = 10'000'000;

class LinkStatesPersonTest : public ::testing::Test {
 protected:
  static PersonState PersonAt(int n) {
    return MakePerson(MakeModel(), Posture(0.05 * n), static_cast<std::uint32_t>(n),
                      kLinksStart + n * kLinksPeriod);
  }
  static xsens_mvn_ros_msgs::LinkStateArray MessageAt(int n) {
    xsens_mvn_ros_msgs::LinkStateArray message;
    FillLinkStates(PersonAt(n), "world", message);
    return message;
  }
  void Take(int n, const xsens_mvn_ros_msgs::LinkStateArray& message) {
    person_.Take(message, {kLinksStart + n * kLinksPeriod + 1'000'000, 1 + n}, origin_, counters_,
                 sink_);
  }

  LinkStatesPerson person_{"xsens"};
  SourceCounters counters_;
  SampleOrigin origin_;
  kinescope::testing::RecordingSink sink_;
};

TEST_F(LinkStatesPersonTest, RestoresPublishedPosesVelocitiesAndAccelerations) {
  for (int n = 0; n < 20; ++n) Take(n, MessageAt(n));
  ASSERT_EQ(sink_.samples.size(), 20U);
  for (int n = 0; n < 20; ++n) {
    const BodySample sent = PersonAt(n).sample;
    const BodySample& got = sink_.samples[static_cast<std::size_t>(n)];
    EXPECT_EQ(got.stamp_nanos, sent.stamp_nanos);
    EXPECT_EQ(got.arrival_nanos, 1 + n);
    EXPECT_EQ(got.counter, static_cast<std::uint32_t>(n));
    EXPECT_TRUE(got.has_linear && got.has_angular);
    for (std::size_t i = 0; i < sent.segments.size(); ++i) {
      EXPECT_EQ(got.segments[i].position, sent.segments[i].position);
      EXPECT_LT(got.segments[i].orientation.angularDistance(sent.segments[i].orientation), 1e-7);
      EXPECT_EQ(got.segments[i].velocity, sent.segments[i].velocity);
      EXPECT_EQ(got.segments[i].acceleration, sent.segments[i].acceleration);
      EXPECT_EQ(got.segments[i].angular_velocity, sent.segments[i].angular_velocity);
      EXPECT_EQ(got.segments[i].angular_acceleration, sent.segments[i].angular_acceleration);
    }
  }
  ASSERT_EQ(sink_.characters.size(), 1U);
  EXPECT_EQ(sink_.characters[0].name, "xsens");
  EXPECT_TRUE(sink_.characters[0].skeleton);
  EXPECT_THAT(counters_.rejected, IsEmpty());
}

TEST_F(LinkStatesPersonTest, UsesTimeStampsOfTheStatesAndIgnoresOtherLinks) {
  auto message = MessageAt(3);
  message.header.stamp = ros::Time();
  message.states.push_back(message.states.back());
  message.states.back().header.frame_id = "generic_link";
  Take(3, message);
  ASSERT_EQ(sink_.samples.size(), 1U);
  EXPECT_EQ(sink_.samples[0].stamp_nanos, kLinksStart + 3 * kLinksPeriod);
}

TEST_F(LinkStatesPersonTest, TreatsAllZeroTwistsAsUnmeasured) {
  auto message = MessageAt(0);
  for (auto& state : message.states) {
    state.twist = {};
    state.accel.angular = {};
  }
  Take(0, message);
  ASSERT_EQ(sink_.samples.size(), 1U);
  EXPECT_TRUE(sink_.samples[0].has_linear) << "there are accelerations";
  EXPECT_FALSE(sink_.samples[0].has_angular);
}

TEST_F(LinkStatesPersonTest, CountsRejectedMessagesAndContinues) {
  for (int n = 0; n < 9; ++n) {
    auto message = MessageAt(n);
    if (n == 1) message.states[4].pose.position.x = std::numeric_limits<double>::infinity();
    if (n == 2) message.states[4].pose.orientation = {};
    if (n == 3) message.states[4].accel.angular.z = std::numeric_limits<double>::quiet_NaN();
    if (n == 4) message.states.pop_back();
    if (n == 5) message.header.stamp = MessageAt(0).header.stamp;
    if (n == 6) message.states.clear();
    if (n == 7) message.states[4].twist.angular.x = -1e206;  // of a bag with a changed byte
    Take(n, message);
  }
  EXPECT_THAT(
      counters_.rejected,
      UnorderedElementsAre(
          Pair("transform with a number that is not finite", 1),
          Pair("transform with a quaternion that is not of unit length", 1),
          Pair("link state with a velocity or acceleration that is not finite, or above 100,000",
               2),
          Pair("sample without all 23 segments", 2)));
  EXPECT_EQ(counters_.duplicates, 1U) << "the stamp of the first once more";
  EXPECT_EQ(sink_.samples.size(), 2U) << "0 and 8";
}

}  // namespace
}  // namespace kinescope::ros_bridge
