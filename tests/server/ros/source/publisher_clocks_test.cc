#include "server/ros/source/publisher_clocks.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <thread>

#include "core/system/clocks.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kWallOffset = 1'700'000'000 * kNanosPerSecond;

// Nodes that answer have a clock that is `ahead_`, and messages take 20 ms.
class PublisherClocksTest : public ::testing::Test {
 protected:
  std::int64_t Wall() const { return monotonic_ + wall_offset_; }
  std::int64_t Message(const std::string& node) {
    monotonic_ += 10 * kNanosPerMilli;
    return clocks_.OnMessage(node, Wall() - 20 * kNanosPerMilli + ahead_, Wall());
  }
  void Person(const std::string& node) {
    Message(node);
    clocks_.OnPerson(node, Wall() - 20 * kNanosPerMilli + ahead_, Wall());
  }
  // Until the node's clock is known.
  bool WaitForAnswer() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < end) {
      clocks_.Update(monotonic_, wall_offset_);
      const auto all = clocks_.Report();
      if (!all.empty() && all.back().offset) return true;
      std::this_thread::yield();  // for the thread that asks
    }
    return false;
  }

  std::int64_t monotonic_ = 1'000 * kNanosPerSecond, wall_offset_ = kWallOffset;
  std::int64_t ahead_ = 0;
  std::atomic<std::int64_t> answer_{0};  // of all nodes; 0: none
  PublisherClocks clocks_{[this](const std::string&) {
    return [this]() -> std::optional<RoundTrip> {
      const std::int64_t theirs = answer_;
      if (theirs == 0) return std::nullopt;
      return RoundTrip{1'000 * kNanosPerSecond - kNanosPerMilli,
                       1'000 * kNanosPerSecond + kNanosPerMilli, theirs};
    };
  }};
};

TEST_F(PublisherClocksTest, CorrectsTheStampsOfANodeThatAnswers) {
  ahead_ = -3 * kNanosPerSecond;
  answer_ = Wall() + ahead_;
  Person("/bridge");
  ASSERT_TRUE(WaitForAnswer());
  EXPECT_EQ(Message("/bridge"), 3 * kNanosPerSecond);
  EXPECT_EQ(Message("/robot"), 0);
  const auto report = clocks_.Report();
  ASSERT_EQ(report.size(), 1U);
  EXPECT_EQ(report[0].node, "/bridge");
  EXPECT_EQ(report[0].offset->nanos, ahead_);
  EXPECT_NEAR(static_cast<double>(report[0].offset->uncertainty_nanos), 1e6, 1e4);
  EXPECT_EQ(report[0].least_lag_nanos, 3 * kNanosPerSecond + 20 * kNanosPerMilli);
}

TEST_F(PublisherClocksTest, KnowsOfTheAgeOfTheLastAnswer) {
  answer_ = Wall();
  Person("/bridge");
  ASSERT_TRUE(WaitForAnswer());
  monotonic_ += 50 * kNanosPerSecond;
  Message("/bridge");
  answer_ = 0;
  clocks_.Update(monotonic_, wall_offset_);
  EXPECT_NEAR(static_cast<double>(clocks_.Report().at(0).offset->uncertainty_nanos), 6e6, 1e4);
}

TEST_F(PublisherClocksTest, FollowsThisComputersClockWhenThatIsSet) {
  answer_ = Wall();
  Person("/bridge");
  ASSERT_TRUE(WaitForAnswer());
  answer_ = 0;
  clocks_.OnOwnClockSet(-5 * kNanosPerSecond);
  wall_offset_ -= 5 * kNanosPerSecond;
  ahead_ = 5 * kNanosPerSecond;
  EXPECT_EQ(Message("/bridge"), -5 * kNanosPerSecond);
  EXPECT_EQ(clocks_.Report().at(0).excess_nanos, 0);
}

// Others fill the graph, too.
TEST_F(PublisherClocksTest, HasRoomForPublishersOfPeopleAlone) {
  for (int i = 0; i < 1000; ++i) Message("/robot_" + std::to_string(i));
  Person("/bridge");
  ASSERT_EQ(clocks_.Report().size(), 1U);
  EXPECT_EQ(clocks_.Report()[0].node, "/bridge");
  for (int i = 0; i < 100; ++i) Person("/suit_" + std::to_string(i));
  EXPECT_EQ(clocks_.Report().size(), PublisherClocks::kMostNodes);
}

TEST_F(PublisherClocksTest, ForgetsANodeOneMinuteAfterItsLastMessage) {
  Person("/bridge");
  monotonic_ += 40 * kNanosPerSecond;
  Message("/bridge");
  monotonic_ += 60 * kNanosPerSecond;  // to the nanosecond
  clocks_.Update(monotonic_, wall_offset_);
  EXPECT_EQ(clocks_.Report().size(), 1U);
  monotonic_ += kNanosPerSecond;
  clocks_.Update(monotonic_, wall_offset_);
  EXPECT_TRUE(clocks_.Report().empty());
}

}  // namespace
}  // namespace kinescope::ros_bridge
