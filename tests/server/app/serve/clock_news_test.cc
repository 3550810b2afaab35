#include "server/app/serve/clock_news.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

// By how much the clock of /bridge_a is `ahead`, in ms, and its messages are delayed by 20 ms.
NodeClock Ahead(std::int64_t ahead, std::int64_t uncertainty = 1) {
  return {"/bridge_a", (20 - ahead) * kNanosPerMilli, (45 - ahead) * kNanosPerMilli,
          NodeClock::Offset{ahead * kNanosPerMilli, uncertainty * kNanosPerMilli}, 0};
}

NodeClock Unasked(std::int64_t lag) {
  return {"/xsens", lag * kNanosPerMilli, (lag + 5) * kNanosPerMilli, std::nullopt, 0};
}

TEST(ClockNews, WarnsOfAClockThatDiffersByMoreThanItsUncertainty) {
  EXPECT_EQ(ClockWarning(Ahead(0)), "");
  EXPECT_EQ(ClockWarning(Ahead(-100)), "");
  EXPECT_EQ(ClockWarning(Ahead(250, 200)), "");
  EXPECT_EQ(ClockWarning(Ahead(-150)),
            "the clock of /bridge_a is 150 ms behind the server's: synchronise both with chrony or "
            "NTP; until then its times are wrong by that");
  NodeClock corrected = Ahead(2980);
  corrected.shift_nanos = -2980 * kNanosPerMilli;
  EXPECT_EQ(ClockWarning(corrected),
            "the clock of /bridge_a is 2.98 s ahead of the server's: synchronise both with chrony "
            "or NTP; until then its times are corrected here, and in nothing that it records or "
            "publishes itself");
}

// They are not corrected, but replaced.
TEST(ClockNews, SaysThatTimesOfArrivalReplaceThoseOfAClockThatWasNeverSet) {
  EXPECT_EQ(ClockWarning(Ahead(std::int64_t{-20'000} * 86'400'000)),
            "the clock of /bridge_a is 20000 days behind the server's: synchronise both with "
            "chrony or NTP; until then the times of arrival are used here");
}

TEST(ClockNews, SaysThatStampsAdvanceSlowly) {
  NodeClock clock = Ahead(0);
  clock.excess_nanos = 2'410 * kNanosPerMilli;
  EXPECT_EQ(ClockWarning(clock),
            "the stamps of /bridge_a advance at 0.9 times the speed of time for 25 s more: they "
            "were ahead, and none may go back");
  EXPECT_EQ(ClockJson(clock)["excess_ms"], 2410.0);
  clock.offset->nanos = -500 * kNanosPerMilli;
  EXPECT_EQ(ClockWarning(clock).find("the clock of /bridge_a is 500 ms behind"), 0U);
  EXPECT_NE(ClockWarning(clock).find("; the stamps of /bridge_a advance"), std::string::npos);
}

TEST(ClockNews, SaysWhatStampsAloneDoNotTell) {
  EXPECT_EQ(ClockWarning(Unasked(400)), "");
  EXPECT_EQ(ClockWarning(Unasked(3050)),
            "the stamps of /xsens are 3.05 s old when they arrive: its clock is behind the "
            "server's, or the network delays its messages; it does not tell which. If the clocks "
            "differ, synchronise both with chrony or NTP; until then its times are wrong by that");
  EXPECT_EQ(ClockWarning(Unasked(-700)),
            "the clock of /xsens is at least 700 ms ahead of the server's: synchronise both with "
            "chrony or NTP; until then its times are wrong by that");
  EXPECT_EQ(ClockWarning(Unasked(std::int64_t{20'000} * 86'400'000)),
            "the stamps of /xsens are 20000 days behind the server's time: its clock was never "
            "set, or it plays a recording; the times of arrival are used");
}

TEST(ClockNews, HasNoLineBreaksOfANodesName) {
  NodeClock clock = Ahead(500);
  clock.node = "/a\nb\x1b[31m";
  EXPECT_EQ(ClockWarning(clock).find_first_of("\n\x1b"), std::string::npos);
}

TEST(ClockNews, GivesTheDelayOnlyIfTheNodeTellsItsTime) {
  EXPECT_EQ(ClockJson(Ahead(-2980)),
            nlohmann::json::parse(R"({"node": "/bridge_a", "offset_ms": -2980.0,
              "uncertainty_ms": 1.0, "delay_ms": 20.0, "most_delay_ms": 45.0, "lag_ms": 3000.0,
              "most_lag_ms": 3025.0, "shift_ms": 0.0, "excess_ms": 0.0, "warning": )" +
                                  nlohmann::json(ClockWarning(Ahead(-2980))).dump() + "}"));
  const nlohmann::json unasked = ClockJson(Unasked(12));
  EXPECT_TRUE(unasked["offset_ms"].is_null());
  EXPECT_TRUE(unasked["delay_ms"].is_null());
  EXPECT_EQ(unasked["lag_ms"], 12.0);
  EXPECT_FALSE(DelayOf(Unasked(12)));
}

}  // namespace
}  // namespace kinescope::app
