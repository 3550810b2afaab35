#include "server/ros/source/publisher_clock.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kMilli = 1'000'000;
constexpr std::int64_t kSecond = 1000 * kMilli;
constexpr std::int64_t kStart = 1'700'000'000 * kSecond;  // of this computer's clock

// A node that sends every 10 ms, whose clock is `ahead`, over a network with `delay`.
class PublisherClockTest : public ::testing::Test {
 protected:
  // By how much the corrected stamp of a message sent now differs from now.
  std::int64_t Send() {
    now_ += 10 * kMilli;
    const std::int64_t stamp = now_ + ahead_;
    clock_.OnStamp(stamp, now_ + delay_);
    return stamp + clock_.shift() - now_;
  }
  std::int64_t SendFor(int secs) {
    for (int i = 1; i < secs * 100; ++i) Send();
    return Send();
  }
  // A question that takes `there` and `back`.
  void Ask(std::int64_t there, std::int64_t back) {
    clock_.OnRoundTrip({now_, now_ + there + back, now_ + there + ahead_});
  }
  NodeClock Report() const { return clock_.Report("/bridge", now_); }

  PublisherClock clock_;
  std::int64_t now_ = kStart;
  std::int64_t ahead_ = 0, delay_ = 20 * kMilli;
};

TEST_F(PublisherClockTest, LeavesTheStampsOfAClockThatIsRight) {
  EXPECT_EQ(SendFor(20), 0);
  delay_ = 900 * kMilli;
  EXPECT_EQ(SendFor(20), 0) << "a delay is no clock";
  EXPECT_EQ(Report().least_lag_nanos, 900 * kMilli);
  EXPECT_FALSE(Report().offset);
}

// It may be a relay, a robot whose stamps lie ahead, or a bag that is played at another rate.
TEST_F(PublisherClockTest, DoesNotShiftTheStampsOfANodeThatDoesNotTellItsTime) {
  for (const std::int64_t ahead : {-3 * kSecond, 5 * kSecond, -5 * 3600 * kSecond}) {
    ahead_ = ahead;
    EXPECT_EQ(SendFor(20), ahead);
    EXPECT_EQ(Report().least_lag_nanos, delay_ - ahead);
  }
}

TEST_F(PublisherClockTest, ShiftsTheStampsOfAClockThatIsWrong) {
  ahead_ = -3 * kSecond;
  Send();
  Ask(5 * kMilli, 5 * kMilli);
  EXPECT_EQ(Send(), 0);
  EXPECT_EQ(clock_.shift(), 3 * kSecond);
}

// An outage of a network, and the backlog after it.
TEST_F(PublisherClockTest, TakesALongDelayForNoClockOnceAsked) {
  Send();
  Ask(5 * kMilli, 5 * kMilli);
  for (const std::int64_t delay : {3 * kSecond, 200 * kSecond, 20 * kMilli}) {
    delay_ = delay;
    EXPECT_EQ(SendFor(15), 0) << delay;
  }
}

TEST_F(PublisherClockTest, TakesARepeatedStampForNoNewTime) {
  Send();
  Ask(5 * kMilli, 5 * kMilli);
  Send();
  for (int i = 1; i < 6000; ++i) {
    clock_.OnStamp(now_, now_ + delay_ + i * 10 * kMilli);
    ASSERT_EQ(clock_.shift(), 0) << i;
  }
}

TEST_F(PublisherClockTest, TellsDelayAndClockApartByARoundTrip) {
  ahead_ = 700 * kMilli;
  delay_ = 60 * kMilli;
  Send();
  Ask(30 * kMilli, 50 * kMilli);
  Send();
  ASSERT_TRUE(Report().offset);
  EXPECT_EQ(Report().offset->nanos, 690 * kMilli) << "as if both ways were equal";
  EXPECT_EQ(Report().offset->uncertainty_nanos, 40 * kMilli);
  Ask(2 * kMilli, 2 * kMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_);
  Ask(100 * kMilli, 2 * kMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_) << "a slow answer does not replace a quick one";
  EXPECT_EQ(Report().least_lag_nanos + Report().offset->nanos, delay_);
}

TEST_F(PublisherClockTest, DoesNotShiftForADelayThatARoundTripExplains) {
  delay_ = 1200 * kMilli;
  Send();
  Ask(300 * kMilli, 300 * kMilli);
  delay_ = 600 * kMilli;
  SendFor(90);
  EXPECT_EQ(clock_.shift(), 0);
}

// The reader takes stamps that go back for those of a node that cannot be trusted.
TEST_F(PublisherClockTest, NeverTurnsTimeBackWhenAClockIsSet) {
  Send();
  Ask(5 * kMilli, 5 * kMilli);
  std::int64_t last = now_ + SendFor(10);
  for (const int ahead : {-3000, 0, 300, -150, 2000, 0, -3'600'000, 0, 3'600'000}) {
    ahead_ = ahead * kMilli;
    std::int64_t off = 0;
    for (int i = 0; i < 1500; ++i) {
      if (i == 100) Ask(5 * kMilli, 5 * kMilli);
      off = Send();
      ASSERT_GT(now_ + off, last) << "message " << i << " after it is " << ahead << " ms ahead";
      last = now_ + off;
    }
    EXPECT_LE(std::abs(off), PublisherClock::kAccepted) << ahead << " ms ahead";
  }
}

TEST_F(PublisherClockTest, TakesOldMessagesAfterAnOutageForDelayed) {
  Send();
  Ask(5 * kMilli, 5 * kMilli);
  SendFor(20);
  now_ += 30 * kSecond;  // cut off; then everything comes at once
  for (int i = 0; i < 3000; ++i) clock_.OnStamp(now_ - 30 * kSecond + i * 10 * kMilli, now_);
  EXPECT_EQ(clock_.shift(), 0);
  EXPECT_EQ(Report().least_lag_nanos, 10 * kMilli) << "of the newest message";
  EXPECT_GT(Report().most_lag_nanos, 29 * kSecond);
}

TEST_F(PublisherClockTest, DoesNotShiftTheStampsOfARecordingThatIsPlayed) {
  ahead_ = -500 * 86'400 * kSecond;
  EXPECT_EQ(SendFor(20), ahead_);
  ahead_ = 0;
  SendFor(1);
  EXPECT_EQ(clock_.shift(), 0) << "and then it is live";
}

TEST_F(PublisherClockTest, IsLessCertainTheOlderTheAnswerIs) {
  Send();
  Ask(2 * kMilli, 2 * kMilli);
  now_ += 104 * kSecond;
  EXPECT_EQ(Report().offset->uncertainty_nanos, 2 * kMilli + 10'399'600) << "0.1 ms per s";
  ahead_ = 10 * kMilli;  // the clocks have drifted
  Ask(8 * kMilli, 8 * kMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_) << "the newer answer is the better one now";
  Ask(9 * kMilli, 8 * kMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_);
  EXPECT_EQ(Report().least_lag_nanos, delay_) << "no clock was set";
}

// Its people go on at once, at the speed of time.
TEST_F(PublisherClockTest, FollowsThisComputersClockWhenThatIsSet) {
  for (const std::int64_t by : {-5 * kSecond, 5 * kSecond, 3'600 * kSecond, -400 * 86'400 * kSecond,
                                400 * 86'400 * kSecond}) {
    Send();
    Ask(5 * kMilli, 5 * kMilli);
    SendFor(10);
    now_ += by;
    ahead_ -= by;
    clock_.OnOwnClockSet(by);
    const std::int64_t off = Send();
    EXPECT_EQ(off, std::abs(ahead_) < NodeClock::kFarNanos ? 0 : ahead_) << by;
    EXPECT_EQ(SendFor(10), off) << by;
    EXPECT_EQ(Report().excess_nanos, 0) << by;
    EXPECT_EQ(Report().offset->nanos, ahead_) << by;
    EXPECT_EQ(clock_.heard(), now_ + delay_) << by;
  }
}

TEST_F(PublisherClockTest, TellsHowFarStampsAreAheadSoThatNoneGoesBack) {
  ahead_ = 3 * kSecond;
  Send();
  Ask(5 * kMilli, 5 * kMilli);
  Send();
  EXPECT_NEAR(static_cast<double>(Report().excess_nanos), 3e9, 2e7);
  SendFor(10);
  EXPECT_NEAR(static_cast<double>(Report().excess_nanos), 2e9, 2e7);
  SendFor(21);
  EXPECT_EQ(Report().excess_nanos, 0);
}

}  // namespace
}  // namespace kinescope::ros_bridge
