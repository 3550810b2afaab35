// Ids of copies, and which samples a slower stream keeps.
#include "server/app/stream/stream_feed.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

TEST(CharacterIds, AreUnchangedWithoutCopies) {
  CharacterIds ids(1);
  for (const int character : {0, 7, 255, 3}) EXPECT_EQ(ids.Find(character, 0), character);
}

TEST(CharacterIds, AreUniqueAndReusedWhenThePersonReturns) {
  CharacterIds ids(3);
  EXPECT_EQ(ids.Find(7, 0), 0);
  EXPECT_EQ(ids.Find(7, 2), 2);
  EXPECT_EQ(ids.Find(2, 0), 3);
  EXPECT_EQ(ids.Find(7, 1), 1) << "met before, so the same ids as then";
  EXPECT_EQ(ids.Find(2, 2), 5);
}

TEST(CharacterIds, AreLimitedToTheRangeOfTheHeader) {
  CharacterIds ids(100);
  std::set<int> found;
  for (int character = 0; character < 4; ++character) {
    for (int copy = 0; copy < 100; ++copy) {
      if (const auto id = ids.Find(character, copy)) found.insert(*id);
    }
  }
  EXPECT_EQ(found.size(), 256U);
  EXPECT_EQ(*found.begin(), 0);
  EXPECT_EQ(*found.rbegin(), 255);
  EXPECT_FALSE(ids.Find(3, 0));
}

// Counters of the samples that are kept of `count` at `rate_hz`, as a clock of `step_nanos` tells.
std::vector<std::uint32_t> KeptOf(Decimator& decimator, double stream_hz, double rate_hz,
                                  std::uint32_t count, std::int64_t step_nanos) {
  std::vector<std::uint32_t> kept;
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto exact = static_cast<std::int64_t>(i * 1e9 / rate_hz);
    if (decimator.Keeps(stream_hz, i, exact / step_nanos * step_nanos, step_nanos))
      kept.push_back(i);
  }
  return kept;
}

TEST(Decimator, KeepsAllSamplesUnlessALowerRateIsRequested) {
  Decimator decimator;
  EXPECT_EQ(KeptOf(decimator, 0, 240, 100, kNanosPerMilli).size(), 100U);
  EXPECT_EQ(KeptOf(decimator, 0, 240, 100, kNanosPerMilli).size(), 100U) << "even the same ones";
}

TEST(Decimator, KeepsOneSamplePerPeriodAtEvenIntervals) {
  for (const auto& [stream_hz, rate_hz] :
       {std::pair(60.0, 240.0), std::pair(30.0, 60.0), std::pair(25.0, 240.0),
        std::pair(100.0, 240.0), std::pair(59.0, 60.0)}) {
    Decimator decimator;
    const std::uint32_t count = static_cast<std::uint32_t>(10 * rate_hz);
    const auto kept = KeptOf(decimator, stream_hz, rate_hz, count, kNanosPerMilli);
    EXPECT_NEAR(static_cast<double>(kept.size()), 10 * stream_hz, 1) << stream_hz;
    EXPECT_EQ(kept.front(), 0U);
    const double apart = rate_hz / stream_hz;
    for (std::size_t i = 1; i < kept.size(); ++i) {
      EXPECT_LT(kept[i] - kept[i - 1], 2 * apart + 1) << stream_hz << " of " << rate_hz;
      EXPECT_LE(apart - 1.5, kept[i] - kept[i - 1]) << stream_hz << " of " << rate_hz;
    }
  }
}

TEST(Decimator, KeepsAllSamplesIfTheRequestedRateIsHigher) {
  Decimator decimator;
  EXPECT_EQ(KeptOf(decimator, 480, 60, 100, kNanosPerMilli).size(), 100U);
}

TEST(Decimator, DecidesEquallyForAllDatagramsOfASampleInAnyOrder) {
  Decimator decimator;
  std::vector<bool> first;
  for (std::uint32_t i = 0; i < 8; ++i)
    first.push_back(decimator.Keeps(60, i, i * 4 * kNanosPerMilli, kNanosPerMilli));
  EXPECT_TRUE(std::find(first.begin(), first.end(), false) != first.end());
  EXPECT_TRUE(std::find(first.begin(), first.end(), true) != first.end());
  for (const std::uint32_t i : {7U, 2U, 5U, 0U, 1U, 6U, 3U, 4U}) {
    EXPECT_EQ(decimator.Keeps(60, i, i * 4 * kNanosPerMilli, kNanosPerMilli), first[i]) << i;
  }
}

// Frames at 240 Hz whose time code is in whole 10 ms: several have the same time.
TEST(Decimator, KeepsItsDecisionWhileTheClockStandsStill) {
  Decimator decimator;
  EXPECT_TRUE(decimator.Keeps(60, 0, 0, kNanosPerMilli));
  for (std::uint32_t i = 1; i < 20; ++i) EXPECT_TRUE(decimator.Keeps(60, i, 0, kNanosPerMilli));
  EXPECT_FALSE(decimator.Keeps(60, 20, 4 * kNanosPerMilli, kNanosPerMilli));
  EXPECT_FALSE(decimator.Keeps(60, 21, 4 * kNanosPerMilli, kNanosPerMilli));
}

}  // namespace
}  // namespace kinescope::app
