#include "server/app/loads/report_text.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinescope::app {
namespace {

// Nothing and all are exact; a few are not nothing.
TEST(ReportText, TellsAFewFromNoneAndMostFromAll) {
  EXPECT_EQ(PercentText(0, 961), "0");
  EXPECT_EQ(PercentText(1, 100'000), "<0.1");
  EXPECT_EQ(PercentText(385, 961), "40.1");
  EXPECT_EQ(PercentText(99'999, 100'000), ">99.9");
  EXPECT_EQ(PercentText(961, 961), "100");
  EXPECT_EQ(PercentText(0, 0), "0");
}

TEST(ReportText, WritesDashesForUnknownNumbers) {
  EXPECT_EQ(NumberOrDash(0.456, 2), "0.46");
  EXPECT_EQ(NumberOrDash(std::numeric_limits<double>::quiet_NaN(), 2), "–");
  EXPECT_EQ(NumberOrDash(std::numeric_limits<double>::infinity(), 2), "–");
}

TEST(ReportText, NamesBothSidesTogetherInTheUsualOrder) {
  EXPECT_EQ(JointWords({14, 0, 4, 3, 2}), "L5/S1, neck (T1/C7), both shoulders, left ankle");
  EXPECT_EQ(JointWords({10, 11}), "left hip, right knee") << "neighbours, not sides of one joint";
  EXPECT_EQ(JointWords({}), "");
}

// "W" is 944 thousandths of the size wide, "i" 222.
TEST(ReportText, KnowsTheWidthOfATextInArial) {
  EXPECT_NEAR(TextWidthMm("WWWWW", 72), 5 * 0.944 * 25.4, 1e-9);
  EXPECT_NEAR(TextWidthMm("iiiii", 72), 5 * 0.222 * 25.4, 1e-9);
}

TEST(ReportText, ShortensToAWidthAndNeverInsideACharacter) {
  EXPECT_EQ(Shortened("short", 7, 100), "short");
  const std::string long_text = "äöü of many words and more words and more";
  const std::string text = Shortened(long_text, 7, 20);
  EXPECT_LE(TextWidthMm(text, 7), 20);
  EXPECT_GT(TextWidthMm(text, 7), 15);
  EXPECT_EQ(text.substr(text.size() - 3), "…");
  EXPECT_EQ(Shortened("äöü", 7, 4.9), "ä…");
  EXPECT_EQ(Shortened("\xFF\xC0", 7, 100), "\uFFFD\uFFFD");
}

}  // namespace
}  // namespace kinescope::app
