#include "server/app/render/render_options.h"

#include <gtest/gtest.h>

#include "core/system/errors.h"
#include "tests/server/options_testing.h"

namespace kinescope::app {
namespace {

TEST(FrameRateValue, AcceptsWholeNumbersDecimalsAndFractionsExactly) {
  struct Case {
    const char* text;
    int numerator, denominator;
  };
  for (const Case& each : {Case{"30", 30, 1},
                           {"12.5", 25, 2},
                           {"60000/2002", 30000, 1001},
                           {"30000/1001", 30000, 1001},
                           {"29.97", 30000, 1001},
                           {"59.94", 60000, 1001},
                           {"23.976", 24000, 1001},
                           {"119.88", 120000, 1001},
                           {"30.0", 30, 1},
                           {"24", 24, 1},
                           {"0.5", 1, 2},
                           {"1000", 1000, 1}}) {
    const render::FrameRate rate = *testing::With<ClipOptions>({{"fps", each.text}}).fps;
    EXPECT_EQ(rate.numerator, each.numerator) << each.text;
    EXPECT_EQ(rate.denominator, each.denominator) << each.text;
  }
}

TEST(FrameRateValue, RejectsInvalidRates) {
  for (const char* text : {"", "0", "0/1", "30/0", "-30", "nan", "inf", "30 ", "1e3", "30/1/1",
                           "1001", "9999999999999999999", "1.2.3", "/", ".", "30,5", "0.00001"}) {
    EXPECT_NE(testing::ErrorOfSetting<ClipOptions>("fps", text), "") << text;
  }
}

TEST(TimeGrid, ContainsTheFramesBeforeItsEndOnly) {
  ClipOptions options;
  options.seconds = 60.0;
  EXPECT_EQ(ToTimeGrid(options, false).count(), 1800);
  options.fps.Parse("29.97");
  EXPECT_EQ(ToTimeGrid(options, false).count(), 1799);  // the last one at 59.993 s
  options.fps.Parse("30");
  options.seconds = 1e-6;
  EXPECT_EQ(ToTimeGrid(options, false).count(), 1);
  options.seconds = 1.0 / 30 + 1e-6;
  EXPECT_EQ(ToTimeGrid(options, false).count(), 2);
}

TEST(TimeGrid, EndsAtTheGivenTimeOrWithTheSource) {
  ClipOptions options;
  EXPECT_FALSE(ToTimeGrid(options, false).count());
  EXPECT_EQ(ToTimeGrid(options, true).count(), 300) << "the subject never ends";
  options.start = 2.0;
  options.end = 3.5;
  const TimeGrid grid = ToTimeGrid(options, false);
  EXPECT_EQ(grid.count(), 45);
  EXPECT_EQ(grid.NanosOf(30), 3'000'000'000);
  for (const double before : {2.0, 1.0}) {
    options.end = before;
    EXPECT_THROW(ToTimeGrid(options, false), UsageError) << before;
  }
  options.end = 3.5;
  options.seconds = 1.0;
  EXPECT_THROW(ToTimeGrid(options, false), UsageError) << "two ends";
  for (const char* never : {"-1", "0", "1e9", "nan"}) {
    EXPECT_NE(testing::ErrorOfSetting<ClipOptions>("end", never), "") << never;
  }
}

}  // namespace
}  // namespace kinescope::app
