#include "server/app/serve/stream_health.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace kinescope::app {
namespace {

constexpr std::int64_t kTick = 500'000'000;
constexpr std::int64_t kStart = 1'000 * kTick;

class StreamHealthTest : public ::testing::Test {
 protected:
  // `ticks` half seconds with 30 samples each, of which `lost` do not come.
  const StreamHealth& Run(int ticks, std::uint64_t lost = 0) {
    for (int i = 0; i < ticks; ++i) {
      counters_.samples += 30 - lost;
      counters_.lost += lost;
      if (lost > 0) ++counters_.counter_gaps;
      Tick();
    }
    return meter_.health();
  }
  const StreamHealth& Silence(int ticks) {
    for (int i = 0; i < ticks; ++i) Tick();
    return meter_.health();
  }
  void Tick() { meter_.OnCounters(counters_, now_ += kTick); }

  SourceCounters counters_;
  StreamHealthMeter meter_;
  std::int64_t now_ = kStart;
};

TEST_F(StreamHealthTest, TellsTheLossOfTheLastTenSecondsAndInAll) {
  EXPECT_EQ(Run(20).recent_loss, 0.0);
  EXPECT_NEAR(*Run(10, 3).recent_loss, 0.05, 1e-9);
  EXPECT_NEAR(*meter_.health().loss, 30.0 / 900, 1e-9);
  EXPECT_NEAR(*Run(10).recent_loss, 0.05, 1e-9);
  EXPECT_NEAR(*Run(5).recent_loss, 0.025, 1e-9);
  EXPECT_EQ(Run(5).recent_loss, 0.0) << "what is over is over";
  EXPECT_NEAR(*meter_.health().loss, 30.0 / 1500, 1e-9) << "and history";
}

// A datagram that is lost rarely takes the whole sample with it.
TEST_F(StreamHealthTest, CountsIncompleteSamplesAsLosses) {
  Run(10);
  counters_.incomplete += 15;
  EXPECT_NEAR(*Run(10).recent_loss, 15.0 / 600, 1e-9);
  EXPECT_EQ(meter_.health().incomplete.recent, 15u);
  EXPECT_EQ(meter_.health().lost, 0u);
  EXPECT_EQ(Run(20).recent_loss, 0.0);
  EXPECT_NEAR(*meter_.health().loss, 15.0 / 1200, 1e-9);
}

TEST_F(StreamHealthTest, HasNoLossWithoutSamples) {
  EXPECT_FALSE(Silence(3).recent_loss);
  EXPECT_FALSE(meter_.health().loss);
  Run(4);
  EXPECT_TRUE(Silence(19).recent_loss);
  EXPECT_FALSE(Silence(1).recent_loss) << "ten seconds of silence";
}

// The counter shows the losses of an outage when it is over.
TEST_F(StreamHealthTest, CountsTheLossesOfAnOutageAtItsTime) {
  Run(20);
  Silence(60);
  counters_.lost += 60 * 30;
  EXPECT_NEAR(*Run(1).recent_loss, 0.97, 0.02);
  EXPECT_NEAR(*Run(9).recent_loss, 0.5, 0.02) << "five of the ten seconds";
  EXPECT_NEAR(*Run(9).recent_loss, 0.09, 0.02) << "one half second of it, and the one of its end";
  EXPECT_EQ(Run(2).recent_loss, 0.0);
  EXPECT_EQ(meter_.health().lost, 1800u);
}

TEST_F(StreamHealthTest, TellsWhenGapsAndRejectedDatagramsWereLast) {
  EXPECT_EQ(Run(4).gaps.last_nanos, 0) << "never";
  counters_.rejected["no MXTP id string"] = 3;
  Run(2, 1);
  const std::int64_t then = now_;
  const StreamHealth& health = Run(10);
  EXPECT_EQ(health.gaps.count, 2u);
  EXPECT_EQ(health.gaps.recent, 2u);
  EXPECT_EQ(health.gaps.last_nanos, then);
  const StreamHealth::Events& rejected = health.rejected.at("no MXTP id string");
  EXPECT_EQ(rejected.count, 3u);
  EXPECT_EQ(rejected.recent, 3u);
  EXPECT_EQ(rejected.last_nanos, then - kTick);
  Run(10);
  EXPECT_EQ(health.gaps.recent, 0u);
  EXPECT_EQ(rejected.recent, 0u);
  EXPECT_EQ(rejected.count, 3u);
}

TEST_F(StreamHealthTest, TellsTheJitterOfTheLastTenSecondsOnly) {
  EXPECT_FALSE(Run(2).jitter);
  for (int i = 0; i < 100; ++i) counters_.delays.Add(i < 90 ? 100'000 : 40'000'000);
  EXPECT_NEAR(static_cast<double>(*Run(1).jitter), 40e6, 1e6);
  Run(19);
  for (int i = 0; i < 100; ++i) counters_.delays.Add(100'000);
  EXPECT_NEAR(static_cast<double>(*Run(1).jitter), 1e5, 5e3);
}

TEST_F(StreamHealthTest, TellsWhenTheClockOfThisMachineWasSet) {
  Run(3);
  counters_.transport["clock_steps"] = 2;
  EXPECT_EQ(Run(1).clock_steps.recent, 2u);
  EXPECT_EQ(meter_.health().clock_steps.last_nanos, now_);
  EXPECT_EQ(Run(20).clock_steps.recent, 0u) << "what is over is over";
  EXPECT_EQ(meter_.health().clock_steps.count, 2u);
}

TEST_F(StreamHealthTest, IsOneJsonObject) {
  counters_.rejected["empty datagram"] = 1;
  Run(3, 3);
  const auto json = nlohmann::json::parse(StreamHealthJson(meter_.health()));
  EXPECT_EQ(json.at("loss_10s"), 0.1);
  EXPECT_EQ(json.at("lost"), 9);
  EXPECT_EQ(json.at("samples"), 81);
  EXPECT_TRUE(json.at("jitter_ms").is_null());
  EXPECT_EQ(json.at("gaps"),
            (nlohmann::json{{"count", 3}, {"count_10s", 3}, {"last_micros", now_ / 1000}}));
  EXPECT_EQ(json.at("rejected").at(0).at("reason"), "empty datagram");
  EXPECT_EQ(json.at("rejected").at(0).at("last_micros"), (kStart + kTick) / 1000);
  EXPECT_TRUE(nlohmann::json::parse(StreamHealthJson({})).at("gaps").at("last_micros").is_null());
}

}  // namespace
}  // namespace kinescope::app
