#include "server/options/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinescope::options {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SplitItems, SeparatesAtSemicolonsAndAtCommasBeforeNames) {
  EXPECT_THAT(SplitItems(""), IsEmpty());
  EXPECT_THAT(SplitItems("  "), IsEmpty());
  EXPECT_THAT(SplitItems("a"), ElementsAre("a"));
  EXPECT_THAT(SplitItems("a, b;c"), ElementsAre("a", "b", "c"));
  EXPECT_THAT(SplitItems("head:1.5,t8:8@-0.15,0,0.1"), ElementsAre("head:1.5", "t8:8@-0.15,0,0.1"));
  EXPECT_THAT(SplitItems("+scale,-legend"), ElementsAre("+scale", "-legend"));
  EXPECT_THAT(SplitItems("front;0,-4,1:0,0,1;top"), ElementsAre("front", "0,-4,1:0,0,1", "top"));
  EXPECT_THAT(SplitItems("f(a,b),g"), ElementsAre("f(a,b)", "g"));
  EXPECT_THAT(SplitItems("a,,b,"), ElementsAre("a", "", "b", ""));
}

TEST(ParseNumber, AcceptsOnlyFiniteNumbers) {
  EXPECT_EQ(ParseNumber("1"), 1);
  EXPECT_EQ(ParseNumber("+2.5"), 2.5);
  EXPECT_EQ(ParseNumber("-.5e1"), -5);
  for (const char* bad : {"", "+", "-", "1a", "a", " 1", "1 ", "nan", "inf", "-inf", "1e400",
                          "0x10", "1,5", "+-1", "--1"}) {
    EXPECT_FALSE(ParseNumber(bad)) << bad;
  }
}

TEST(ParseNumber, AcceptsEveryPrintedNumber) {
  for (const double number :
       {0.0, 0.1, 1.0 / 3, 1e-300, 1e300, -123456789.125, std::numeric_limits<double>::min()}) {
    EXPECT_EQ(ParseNumber(NumberText(number)), number);
  }
}

TEST(ParseNumbers, RequiresANumberBetweenCommas) {
  EXPECT_THAT(*ParseNumbers("1, -2.5,3e2"), ElementsAre(1, -2.5, 300));
  for (const char* bad : {"", "1,", ",1", "1,,2", "1;2", "1,x"})
    EXPECT_FALSE(ParseNumbers(bad)) << bad;
}

}  // namespace
}  // namespace kinescope::options
