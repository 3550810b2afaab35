#include "server/alarms/watch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace kinescope::alarms {
namespace {

using Step = Watch::Step;

Rule MakeRule() {
  Rule rule;
  rule.limit = 10;
  rule.band = 2;
  rule.for_secs = 0.5;
  rule.over_secs = 1;
  return rule;
}

// One value each 0.1 s. '.': nothing, 'B': begins, 'E': ends.
class Strip {
 public:
  explicit Strip(Rule rule) : rule_(std::move(rule)) {}

  std::string Feed(std::optional<double> value, int count) {
    std::string steps;
    for (int i = 0; i < count; ++i) {
      ++number_;
      const Step step = watch_.OnValue(rule_, value, {number_, 100'000'000 * Number(), 0});
      steps += step == Step::kBegins ? 'B' : step == Step::kEnds ? 'E' : '.';
    }
    return steps;
  }
  void Skip(int count) { number_ += static_cast<std::uint64_t>(count); }
  Watch& watch() { return watch_; }

 private:
  std::int64_t Number() const { return static_cast<std::int64_t>(number_); }

  Rule rule_;
  Watch watch_;
  std::uint64_t number_ = 0;
};

TEST(Watch, BeginsAfterTheDelayAndSaysTheFirstSampleBeyond) {
  Strip strip(MakeRule());
  EXPECT_EQ(strip.Feed(9, 3), "...");
  EXPECT_EQ(strip.Feed(11, 7), ".....B.");
  EXPECT_EQ(strip.watch().since().state, 4u);
}

TEST(Watch, AValueAtTheLimitIsNotBeyondIt) {
  Strip strip(MakeRule());
  EXPECT_EQ(strip.Feed(10, 20), std::string(20, '.'));
}

TEST(Watch, ADelayBeginsAnewWhenTheValueReturns) {
  Strip strip(MakeRule());
  EXPECT_EQ(strip.Feed(11, 5), ".....");
  EXPECT_EQ(strip.Feed(9, 1), ".");
  EXPECT_EQ(strip.Feed(11, 6), ".....B");
  EXPECT_EQ(strip.watch().since().state, 7u);
}

TEST(Watch, EndsWhenInsideTheBandForLongEnough) {
  Strip strip(MakeRule());
  strip.Feed(11, 6);
  EXPECT_EQ(strip.Feed(9, 30), std::string(30, '.')) << "inside the limit, not inside the band";
  EXPECT_EQ(strip.Feed(8, 5), ".....");
  EXPECT_EQ(strip.Feed(9, 1), ".");
  EXPECT_EQ(strip.Feed(8, 11), "..........E");
  EXPECT_FALSE(strip.watch().is_on());
}

TEST(Watch, UnknownNeitherBeginsNorEnds) {
  Strip strip(MakeRule());
  EXPECT_EQ(strip.Feed(std::nullopt, 50), std::string(50, '.'));
  EXPECT_EQ(strip.Feed(11, 3), "...");
  EXPECT_EQ(strip.Feed(std::nullopt, 50), std::string(50, '.')) << "its time does not count";
  EXPECT_EQ(strip.Feed(11, 3), "...");
  EXPECT_EQ(strip.Feed(11, 1), "B") << "0.2 s before it, and 0.3 s after it";
  EXPECT_EQ(strip.Feed(std::nullopt, 50), std::string(50, '.'));
  EXPECT_TRUE(strip.watch().is_on());
  EXPECT_EQ(strip.Feed(8, 11), "..........E");
}

TEST(Watch, TimeWithoutValuesDoesNotCount) {
  Strip strip(MakeRule());
  strip.Feed(11, 1);
  strip.Skip(100);
  EXPECT_EQ(strip.Feed(11, 6), ".....B");
}

TEST(Watch, WithoutADelayOneSampleIsEnough) {
  Rule rule = MakeRule();
  rule.for_secs = rule.over_secs = 0;
  Strip strip(rule);
  EXPECT_EQ(strip.Feed(11, 2), "B.");
  EXPECT_EQ(strip.Feed(8, 2), "E.");
}

TEST(Watch, AMarginRaisesWhenItIsTooSmall) {
  Rule rule = MakeRule();
  rule.quantity = Quantity::kMargin;
  rule.limit = -0.1;
  rule.band = 0.02;
  Strip strip(rule);
  EXPECT_EQ(strip.Feed(-0.05, 10), std::string(10, '.'));
  EXPECT_EQ(strip.Feed(-0.2, 6), ".....B");
  strip.Feed(-0.3, 1);
  EXPECT_EQ(strip.watch().worst(), -0.3);
  EXPECT_EQ(strip.Feed(-0.09, 20), std::string(20, '.'));
  EXPECT_EQ(strip.Feed(-0.05, 11), "..........E");
}

TEST(Watch, TheWorstIsThatSinceTheFirstSampleBeyond) {
  Strip strip(MakeRule());
  strip.Feed(50, 1);  // another time
  strip.Feed(5, 1);
  strip.Feed(11, 2);
  strip.Feed(14, 1);
  strip.Feed(11, 4);
  EXPECT_TRUE(strip.watch().is_on());
  EXPECT_EQ(strip.watch().worst(), 14);
}

TEST(Watch, WhatIsGoneEnds) {
  Strip strip(MakeRule());
  EXPECT_EQ(strip.watch().OnGone(), Step::kNothing);
  strip.Feed(11, 6);
  EXPECT_EQ(strip.watch().OnGone(), Step::kEnds);
  EXPECT_EQ(strip.Feed(11, 6), ".....B");
}

}  // namespace
}  // namespace kinescope::alarms
