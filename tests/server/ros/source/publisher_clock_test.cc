#include "server/ros/source/publisher_clock.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>

#include "core/system/clocks.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kClockStart = 1'700'000'000 * kNanosPerSecond;  // of this computer's clock

// A node that sends every 10 ms, whose clock is `ahead`, over a network with `delay`.
class PublisherClockTest : public ::testing::Test {
 protected:
  // By how much the corrected stamp of a message sent now differs from now.
  std::int64_t Send() {
    now_ += 10 * kNanosPerMilli;
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
  std::int64_t now_ = kClockStart;
  std::int64_t ahead_ = 0, delay_ = 20 * kNanosPerMilli;
};

TEST_F(PublisherClockTest, LeavesTheStampsOfAClockThatIsRight) {
  EXPECT_EQ(SendFor(20), 0);
  delay_ = 900 * kNanosPerMilli;
  EXPECT_EQ(SendFor(20), 0) << "a delay is no clock";
  EXPECT_EQ(Report().least_lag_nanos, 900 * kNanosPerMilli);
  EXPECT_FALSE(Report().offset);
}

// It may be a relay, a robot whose stamps lie ahead, or a bag that is played at another rate.
TEST_F(PublisherClockTest, DoesNotShiftTheStampsOfANodeThatDoesNotTellItsTime) {
  for (const std::int64_t ahead :
       {-3 * kNanosPerSecond, 5 * kNanosPerSecond, -5 * 3600 * kNanosPerSecond}) {
    ahead_ = ahead;
    EXPECT_EQ(SendFor(20), ahead);
    EXPECT_EQ(Report().least_lag_nanos, delay_ - ahead);
  }
}

TEST_F(PublisherClockTest, ShiftsTheStampsOfAClockThatIsWrong) {
  ahead_ = -3 * kNanosPerSecond;
  Send();
  Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
  EXPECT_EQ(Send(), 0);
  EXPECT_EQ(clock_.shift(), 3 * kNanosPerSecond);
}

// An outage of a network, and the backlog after it.
TEST_F(PublisherClockTest, TakesALongDelayForNoClockOnceAsked) {
  Send();
  Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
  for (const std::int64_t delay :
       {3 * kNanosPerSecond, 200 * kNanosPerSecond, 20 * kNanosPerMilli}) {
    delay_ = delay;
    EXPECT_EQ(SendFor(15), 0) << delay;
  }
}

TEST_F(PublisherClockTest, TakesARepeatedStampForNoNewTime) {
  Send();
  Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
  Send();
  for (int i = 1; i < 6000; ++i) {
    clock_.OnStamp(now_, now_ + delay_ + i * 10 * kNanosPerMilli);
    ASSERT_EQ(clock_.shift(), 0) << i;
  }
}

TEST_F(PublisherClockTest, TellsDelayAndClockApartByARoundTrip) {
  ahead_ = 700 * kNanosPerMilli;
  delay_ = 60 * kNanosPerMilli;
  Send();
  Ask(30 * kNanosPerMilli, 50 * kNanosPerMilli);
  Send();
  ASSERT_TRUE(Report().offset);
  EXPECT_EQ(Report().offset->nanos, 690 * kNanosPerMilli) << "as if both ways were equal";
  EXPECT_EQ(Report().offset->uncertainty_nanos, 40 * kNanosPerMilli);
  Ask(2 * kNanosPerMilli, 2 * kNanosPerMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_);
  Ask(100 * kNanosPerMilli, 2 * kNanosPerMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_) << "a slow answer does not replace a quick one";
  EXPECT_EQ(Report().least_lag_nanos + Report().offset->nanos, delay_);
}

TEST_F(PublisherClockTest, DoesNotShiftForADelayThatARoundTripExplains) {
  delay_ = 1200 * kNanosPerMilli;
  Send();
  Ask(300 * kNanosPerMilli, 300 * kNanosPerMilli);
  delay_ = 600 * kNanosPerMilli;
  SendFor(90);
  EXPECT_EQ(clock_.shift(), 0);
}

// The reader takes stamps that go back for those of a node that cannot be trusted.
TEST_F(PublisherClockTest, NeverTurnsTimeBackWhenAClockIsSet) {
  Send();
  Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
  std::int64_t last = now_ + SendFor(10);
  for (const int ahead : {-3000, 0, 300, -150, 2000, 0, -3'600'000, 0, 3'600'000}) {
    ahead_ = ahead * kNanosPerMilli;
    std::int64_t off = 0;
    for (int i = 0; i < 1500; ++i) {
      if (i == 100) Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
      off = Send();
      ASSERT_GT(now_ + off, last) << "message " << i << " after it is " << ahead << " ms ahead";
      last = now_ + off;
    }
    EXPECT_LE(std::abs(off), PublisherClock::kAccepted) << ahead << " ms ahead";
  }
}

TEST_F(PublisherClockTest, TakesOldMessagesAfterAnOutageForDelayed) {
  Send();
  Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
  SendFor(20);
  now_ += 30 * kNanosPerSecond;  // cut off; then everything comes at once
  for (int i = 0; i < 3000; ++i)
    clock_.OnStamp(now_ - 30 * kNanosPerSecond + i * 10 * kNanosPerMilli, now_);
  EXPECT_EQ(clock_.shift(), 0);
  EXPECT_EQ(Report().least_lag_nanos, 10 * kNanosPerMilli) << "of the newest message";
  EXPECT_GT(Report().most_lag_nanos, 29 * kNanosPerSecond);
}

TEST_F(PublisherClockTest, DoesNotShiftTheStampsOfARecordingThatIsPlayed) {
  ahead_ = -500 * 86'400 * kNanosPerSecond;
  EXPECT_EQ(SendFor(20), ahead_);
  ahead_ = 0;
  SendFor(1);
  EXPECT_EQ(clock_.shift(), 0) << "and then it is live";
}

TEST_F(PublisherClockTest, IsLessCertainTheOlderTheAnswerIs) {
  Send();
  Ask(2 * kNanosPerMilli, 2 * kNanosPerMilli);
  now_ += 104 * kNanosPerSecond;
  EXPECT_EQ(Report().offset->uncertainty_nanos, 2 * kNanosPerMilli + 10'399'600) << "0.1 ms per s";
  ahead_ = 10 * kNanosPerMilli;  // the clocks have drifted
  Ask(8 * kNanosPerMilli, 8 * kNanosPerMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_) << "the newer answer is the better one now";
  Ask(9 * kNanosPerMilli, 8 * kNanosPerMilli);
  EXPECT_EQ(Report().offset->nanos, ahead_);
  EXPECT_EQ(Report().least_lag_nanos, delay_) << "no clock was set";
}

// Its people go on at once, at the speed of time.
TEST_F(PublisherClockTest, FollowsThisComputersClockWhenThatIsSet) {
  for (const std::int64_t by : {-5 * kNanosPerSecond, 5 * kNanosPerSecond, 3'600 * kNanosPerSecond,
                                -400 * 86'400 * kNanosPerSecond, 400 * 86'400 * kNanosPerSecond}) {
    Send();
    Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
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
  ahead_ = 3 * kNanosPerSecond;
  Send();
  Ask(5 * kNanosPerMilli, 5 * kNanosPerMilli);
  Send();
  EXPECT_NEAR(static_cast<double>(Report().excess_nanos), 3e9, 2e7);
  SendFor(10);
  EXPECT_NEAR(static_cast<double>(Report().excess_nanos), 2e9, 2e7);
  SendFor(21);
  EXPECT_EQ(Report().excess_nanos, 0);
}

}  // namespace
}  // namespace kinescope::ros_bridge
