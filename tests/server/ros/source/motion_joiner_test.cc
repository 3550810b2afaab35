#include "server/ros/source/motion_joiner.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

#include "server/ros/link_states.h"
#include "tests/recording_sink.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kJoinedPeriod = 10'000'000;

class MotionJoinerTest : public ::testing::Test {
 protected:
  MotionJoinerTest() {
    joiner_.SetSink(&sink_);
    joiner_.Expect();
  }

  // Two people at the same times in different places.
  static PersonState PersonAt(int character, int n) {
    static const PersonState kStanding =
        testing::MakePerson(testing::MakeModel(), testing::Posture(1), 0, 0);
    PersonState person = kStanding;
    person.sample.counter = static_cast<std::uint32_t>(n);
    person.sample.stamp_nanos = (n + 1) * kJoinedPeriod;
    person.sample.character = character;
    for (SegmentState& segment : person.sample.segments) segment.position.y() += character;
    for (urdf::Pose& link : person.links) link.position.y() += character;
    return person;
  }
  void Sample(int character, int n) {
    BodySample sample = PersonAt(character, n).sample;
    sample.has_linear = sample.has_angular = false;
    joiner_.OnSample(sample);
  }
  void LinkStates(int character, int n) {
    xsens_mvn_ros_msgs::LinkStateArray message;
    FillLinkStates(PersonAt(character, n), "world", message);
    EXPECT_TRUE(joiner_.Take(message, counters_));
  }
  std::size_t WithMotion(int character) const {
    std::size_t count = 0;
    for (const BodySample& sample : sink_.samples) {
      count += sample.character == character && sample.has_linear ? 1 : 0;
    }
    return count;
  }

  kinescope::testing::RecordingSink sink_;
  MotionJoiner joiner_;
  SourceCounters counters_;
};

// A recorder on a busy computer writes what has come of one topic, then of the other: of 1360
// samples 379 had no velocities.
TEST_F(MotionJoinerTest, JoinsWhatARecorderWroteInRuns) {
  int n = 0;
  for (const int run : {1, 2, 24, 5, 60}) {
    for (int i = 0; i < run; ++i) Sample(0, n + i);
    for (int i = 0; i < run; ++i) LinkStates(0, n + i);
    n += run;
    for (int i = 0; i < run; ++i) LinkStates(0, n + i);
    for (int i = 0; i < run; ++i) Sample(0, n + i);
    n += run;
  }
  joiner_.Flush();
  EXPECT_EQ(sink_.samples.size(), static_cast<std::size_t>(n));
  EXPECT_EQ(WithMotion(0), static_cast<std::size_t>(n));
}

TEST_F(MotionJoinerTest, KeepsTheOrderOfAllThatWaits) {
  joiner_.OnSurroundings({});
  Sample(0, 0);
  Sample(1, 0);
  RecordedSurroundings later;
  later.markers.push_back(std::make_shared<const SceneMarker>());
  joiner_.OnSurroundings(later);
  Sample(0, 1);
  LinkStates(1, 0);
  EXPECT_TRUE(sink_.samples.empty()) << "the first one waits";
  LinkStates(0, 0);
  ASSERT_EQ(sink_.samples.size(), 2U);
  LinkStates(0, 1);
  ASSERT_EQ(sink_.samples.size(), 3U);
  EXPECT_EQ(sink_.samples[0].character, 0);
  EXPECT_EQ(sink_.samples[1].character, 1);
  EXPECT_TRUE(sink_.markers[0].empty() && sink_.markers[1].empty());
  EXPECT_EQ(sink_.markers[2].size(), 1U);
}

TEST_F(MotionJoinerTest, GoesOnWithoutThoseThatAreMissing) {
  Sample(0, 0);
  Sample(0, 1);
  LinkStates(0, 1);
  ASSERT_EQ(sink_.samples.size(), 2U);
  EXPECT_FALSE(sink_.samples[0].has_linear);
  EXPECT_TRUE(sink_.samples[1].has_linear);
}

TEST_F(MotionJoinerTest, DoesNotWaitForeverForAPersonWithoutLinkStates) {
  constexpr int kLong = 3 * static_cast<int>(MotionJoiner::kMostWaiting);
  for (int n = 0; n < kLong; ++n) {
    Sample(0, n);
    Sample(1, n);
    LinkStates(0, n);
  }
  EXPECT_EQ(sink_.samples.size(), 2U * kLong) << "none of the last ones waits";
  EXPECT_EQ(WithMotion(0), static_cast<std::size_t>(kLong));
  EXPECT_EQ(WithMotion(1), 0U);
  // The other one's are recorded from now on.
  constexpr int kEnd = kLong + 2 * static_cast<int>(MotionJoiner::kMostWaiting);
  for (int n = kLong; n < kEnd; ++n) {
    Sample(0, n);
    Sample(1, n);
    LinkStates(0, n);
    LinkStates(1, n);
  }
  EXPECT_GT(WithMotion(1), MotionJoiner::kMostWaiting / 2);
}

}  // namespace
}  // namespace kinescope::ros_bridge
