#include "server/app/loads/report_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>

#include "server/table/load_rows.h"
#include "tests/server/app/loads/trial_scenes.h"

namespace kinescope::app {
namespace {

using testing::CountedTrial;
using ::testing::HasSubstr;
using ::testing::Not;

std::string RowOf(const std::string& html, const std::string& label) {
  const std::size_t at = html.find("<th>" + label + "</th>");
  if (at == std::string::npos) return "";
  return html.substr(at, html.find("</tr>", at) - at);
}

// Of the cells with a count.
std::uint64_t SumOfCounts(const std::string& row) {
  static const std::regex kCount("<td class=\"c[ z]*\">([0-9]+)</td>");
  std::uint64_t sum = 0;
  for (std::sregex_iterator each(row.begin(), row.end(), kCount), end; each != end; ++each) {
    sum += std::stoull((*each)[1]);
  }
  return sum;
}

TEST(ExposureTable, ShowsSharesOfAllSamplesWithTheirCounts) {
  const std::string row = RowOf(ExposureTable(CountedTrial(), TrialContext()), "Right knee");
  EXPECT_THAT(row, HasSubstr("<td class=\"p\">50.0</td><td class=\"c\">50</td>"
                             "<td class=\"p\">30.0</td><td class=\"c\">30</td>"
                             "<td class=\"p\">15.0</td><td class=\"c\">15</td>"
                             "<td class=\"p\">5.0</td><td class=\"c\">5</td>"));
  // Percentiles of the 95 known samples; above 0.6 from 8.0 s for 1.5 s, once.
  EXPECT_THAT(row, HasSubstr("<td>0.20</td><td>0.20</td><td>0.90</td>"
                             "<td>1.50</td><td>1</td><td>6.3</td>"));
  EXPECT_THAT(row, HasSubstr("<td>0.90</td><td>8.00</td><td class=\"tx\">flexion, 90 of 100</td>"));
}

TEST(ExposureTable, HasOneRowPerJointWhoseCountsAddUpToAllSamples) {
  const std::string html = ExposureTable(CountedTrial(), TrialContext());
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    EXPECT_EQ(SumOfCounts(RowOf(html, std::string(ScoredLabel(i)))), 100U) << ScoredLabel(i);
  }
  EXPECT_THAT(html, HasSubstr("each row adds up to 100 samples"));
}

TEST(ExposureTable, PrintsZeroPaleAndUnknownAsADash) {
  const std::string low = RowOf(ExposureTable(CountedTrial(), TrialContext()), "Left knee");
  EXPECT_THAT(low, HasSubstr("<td class=\"p\">100</td><td class=\"c\">100</td>"
                             "<td class=\"p z\">0</td><td class=\"c z\">0</td>"));
  EXPECT_THAT(low, HasSubstr("<td class=\"z\">0</td><td class=\"z\">0</td><td class=\"z\">0</td>"));
  LoadTrial unknown(true, 0);
  testing::AddTo(unknown, testing::SceneWithRatio(0, std::nan(""), "no foot contact"));
  unknown.Finish();
  const std::string html = ExposureTable(unknown, TrialContext());
  EXPECT_THAT(RowOf(html, "Left knee"),
              HasSubstr("<td class=\"p\">100</td><td class=\"c\">1</td>"
                        "<td>–</td><td>–</td><td>–</td><td>–</td><td>–</td><td>–</td><td>–</td>"
                        "<td>–</td><td class=\"tx\">–</td>"));
  EXPECT_THAT(html, Not(HasSubstr("nan")));
}

TEST(ExposureTable, MarksRatiosAboveOneAndExtrapolatedRates) {
  LoadTrial trial(true, 0);
  testing::AddTo(trial, testing::SceneWithRatio(0, 0.1));
  testing::AddTo(trial, testing::SceneWithRatio(0.1, 1.25));
  trial.Finish();
  const std::string html = ExposureTable(trial, TrialContext());
  EXPECT_THAT(RowOf(html, "L5/S1"), HasSubstr("<td class=\"ov\">1.25‡</td><td>0.10</td>"));
  EXPECT_THAT(html, HasSubstr("per<br>min†"));
  EXPECT_THAT(html, HasSubstr("† extrapolated from 0.20 s."));
  LoadTrial minute(true, 0);
  for (int i = 0; i <= 600; ++i) testing::AddTo(minute, testing::SceneWithRatio(0.1 * i, 0.1));
  minute.Finish();
  EXPECT_THAT(ExposureTable(minute, TrialContext()), Not(HasSubstr("†")));
}

TEST(ExposureTable, HasTheGivenLimits) {
  TrialContext context;
  context.scene.loads.meter = loads::LoadMeter::WithLimits({0.1, 0.25});
  const std::string html = ExposureTable(CountedTrial(), context);
  for (const char* text : {"≤ 0.1<", "≤ 0.25<", "&gt; 0.25<"}) EXPECT_THAT(html, HasSubstr(text));
}

SensitivityRow RowWith(const std::string& label, std::uint64_t low_back, std::uint64_t knee,
                       double compression) {
  SensitivityRow row;
  row.label = label;
  row.samples = row.compressions = 200;
  row.is_known.fill(true);
  row.above[1][urdf::kScoredL5S1] = low_back;
  row.above[1][11] = knee;
  row.above[0] = row.above[1];
  row.low_back_p90 = 0.75F;
  row.peak_compression = compression;
  row.above_action_limit = compression > 3400 ? 10 : 0;
  return row;
}

TEST(SensitivityTable, ShowsWhatEachRunChanges) {
  const std::string html =
      SensitivityTable({RowWith("as computed", 80, 40, 3800), RowWith("mass 67.5 kg", 56, 20, 3300),
                        RowWith("<weak>", 120, 80, 3800)},
                       kDefaultClassLimits);
  EXPECT_THAT(RowOf(html, "as computed"), HasSubstr("<td>40.0</td><td>0.75</td><td>0</td>"
                                                    "<td>20.0</td><td>3800</td><td>5.0</td>"));
  EXPECT_THAT(RowOf(html, "mass 67.5 kg"), HasSubstr("<td>28.0</td>"));
  EXPECT_THAT(html, HasSubstr("Right<br>knee<br>high %"));
  EXPECT_THAT(html,
              HasSubstr("share of L5/S1 moves most with &#60;weak&#62;: +20.0 percentage points"));
  EXPECT_THAT(html, HasSubstr("above 3400 N in 2 of 3 rows"));
}

// Columns of zeros would say nothing.
TEST(SensitivityTable, ComparesAtTheLowerLimitIfNoRunIsEverAboveTheUpper) {
  SensitivityRow row = RowWith("as computed", 0, 0, 900);
  row.above[0][8] = 150;
  const std::string html = SensitivityTable({row}, {0.3, 0.6});
  EXPECT_THAT(html, HasSubstr("<th>L5/S1<br>&#62; 0.3, %</th>"));
  EXPECT_THAT(html, HasSubstr("<th>Left<br>wrist<br>&#62; 0.3, %</th>"));
  EXPECT_THAT(RowOf(html, "as computed"), HasSubstr("<td>75.0</td>"));
}

TEST(SensitivityTable, PrintsDashesForUnknownValues) {
  SensitivityRow row;
  row.label = "as computed";
  row.samples = 3;
  EXPECT_THAT(RowOf(SensitivityTable({row}, kDefaultClassLimits), "as computed"),
              HasSubstr("<td>–</td><td>–</td><td>–</td><td>–</td>"));
  EXPECT_EQ(SensitivityTable({}, kDefaultClassLimits), "");
}

}  // namespace
}  // namespace kinescope::app
