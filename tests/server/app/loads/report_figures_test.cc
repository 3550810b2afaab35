// The figures of the report, read back as XML.
#include "server/app/loads/report_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>

#include "server/app/loads/svg.h"
#include "tests/server/app/loads/trial_scenes.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::app {
namespace {

using testing::AddTo;
using testing::CountedTrial;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::SceneWithRatio;

constexpr double kFigureMm = 55;

std::size_t TimesIn(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

const std::string kHighFill = "fill=\"#c21414\"";

std::vector<std::string> AllFigures(const LoadTrial& trial) {
  const TrialContext context;
  return {TimeFigure(trial, context, kFigureMm), DistributionFigure(trial, context),
          ShareBar(trial.exposure().Of(11), 24), StateKey(LoadClass::kMedium)};
}

TEST(ReportFigures, AreXmlOfTheirSizeWithoutNumbersThatAreNotFinite) {
  LoadTrial one(true, 0), unknown(true, 0);
  AddTo(one, SceneWithRatio(0, 0.7));
  AddTo(unknown, SceneWithRatio(0, std::nan(""), "no foot contact"));
  AddTo(unknown, SceneWithRatio(0.1, std::nan(""), "no foot contact"));
  one.Finish();
  unknown.Finish();
  for (const LoadTrial& trial : {CountedTrial(), one, unknown}) {
    for (const std::string& svg : AllFigures(trial)) {
      const urdf::XmlOutline outline = urdf::ReadOutline(svg);
      EXPECT_EQ(outline[0].tag, "svg");
      EXPECT_THAT(*outline[0].Attribute("width"), ::testing::EndsWith("mm"));
      for (const char* word : {"nan", "inf", "-0\""}) EXPECT_THAT(svg, Not(HasSubstr(word)));
    }
  }
}

// One size, whose millimetres are those of the paper.
TEST(ReportFigures, HaveTextOfAtLeastSevenPoints) {
  EXPECT_GE(kSvgTextMm * 72 / 25.4, 7);
  for (const std::string& svg : AllFigures(CountedTrial())) {
    EXPECT_EQ(TimesIn(svg, "font-size="), 1U);
    EXPECT_THAT(svg, HasSubstr("font-size=\"2.5\""));
    EXPECT_THAT(svg, Not(HasSubstr("transform")));
  }
}

TEST(ReportFigures, DrawOneBarPerTimeAboveTheLimitAndHatchUnknownTimes) {
  const std::string svg = TimeFigure(CountedTrial(), TrialContext(), kFigureMm);
  EXPECT_THAT(svg, HasSubstr(">R knee<"));
  EXPECT_THAT(svg, Not(HasSubstr(">L knee<"))) << "it is never high";
  EXPECT_EQ(TimesIn(svg, kHighFill), 1U);
  // From 8.0 to 9.5 s of 9.9 s, on an axis from 17 to 90 mm.
  std::smatch bar;
  ASSERT_TRUE(std::regex_search(
      svg, bar,
      std::regex("<rect x=\"([0-9.]+)\" y=\"[0-9.]+\" width=\"([0-9.]+)\"[^>]*" + kHighFill)));
  EXPECT_NEAR(std::stod(bar[1]), 17 + 73 * 8.0 / 9.9, 0.01);
  EXPECT_NEAR(std::stod(bar[2]), 73 * 1.5 / 9.9, 0.01);
}

TEST(ReportFigures, ShowThePeakCompressionAndBothLimits) {
  const std::string svg = TimeFigure(CountedTrial(4200), TrialContext(), kFigureMm);
  for (const char* text : {">4200 N at 7.00 s<", ">3400 N<", ">6400 N<"}) {
    EXPECT_THAT(svg, HasSubstr(text));
  }
}

TEST(ReportFigures, ShowContactOfTheFeetAndTheHandLoad) {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 20; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, 0.1);
    scene.people[0].forces.feet[urdf::kRight].touches_floor = i < 10;
    scene.people[0].forces.hands[urdf::kLeft].mass_kg = i < 5 ? 0 : 7.5;
    AddTo(trial, scene);
  }
  trial.Finish();
  const std::string svg = TimeFigure(trial, TrialContext(), kFigureMm);
  EXPECT_THAT(svg, HasSubstr(">hands 7.5 kg<"));
  EXPECT_EQ(TimesIn(svg, "fill=\"#858f9e\""), 2U) << "right foot and hands, once each";
  EXPECT_THAT(TimeFigure(CountedTrial(), TrialContext(), kFigureMm), Not(HasSubstr(">hands")));
}

// A row has a bounded number of bars, however often a load rises.
TEST(ReportFigures, StaySmallInLongTrials) {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 20'000; ++i) AddTo(trial, SceneWithRatio(0.1 * i, i % 4 == 0 ? 0.9 : 0.1));
  trial.Finish();
  const std::string svg = TimeFigure(trial, TrialContext(), kFigureMm);
  EXPECT_LT(TimesIn(svg, kHighFill), 2000U);
  EXPECT_THAT(svg, HasSubstr("height is share of time"));
  EXPECT_THAT(svg, HasSubstr(">min<"));
  // A quarter of the time: a quarter of the height of a bar.
  EXPECT_THAT(svg, ::testing::ContainsRegex("height=\"0.4[78]\" " + kHighFill));
}

TEST(ReportFigures, ShowTheDistributionOfEachJointWithItsPercentiles) {
  const std::string svg = DistributionFigure(CountedTrial(), TrialContext());
  for (const char* title :
       {"L5/S1", "T9/T8", "Neck", "Shoulders", "Elbows", "Wrists", "Hips", "Knees", "Ankles"}) {
    EXPECT_EQ(TimesIn(svg, std::string(">") + title + "<"), 1U) << title;
  }
  EXPECT_EQ(TimesIn(svg, "<circle"), 15U * 3);
  EXPECT_EQ(TimesIn(svg, "stroke-dasharray=\"0.9 0.6\""), 6U) << "the left side of six pairs";
}

TEST(ReportFigures, SayWhichJointsAreUnknown) {
  LoadTrial trial(true, 0);
  for (int i = 0; i < 10; ++i) {
    SceneState scene = SceneWithRatio(0.1 * i, 0.1);
    for (const std::size_t ankle : {13, 14}) {
      scene.people[0].loads[ankle].ratio = std::nan("");
      scene.people[0].loads[ankle].band = LoadClass::kUnknown;
    }
    AddTo(trial, scene);
  }
  trial.Finish();
  EXPECT_EQ(TimesIn(DistributionFigure(trial, TrialContext()), ">unknown<"), 1U);
}

TEST(ReportFigures, DrawABarWhosePartsAreTheShares) {
  const std::string svg = ShareBar(CountedTrial().exposure().Of(11), 24);
  EXPECT_THAT(svg,
              HasSubstr("aria-label=\"low 50.0 %, medium 30.0 %, high 15.0 %, unknown 5.0 %\""));
  EXPECT_THAT(svg, HasSubstr("width=\"11.95\""));  // half of 23.9
  EXPECT_THAT(svg, HasSubstr("width=\"3.58\" height=\"2.4\" " + kHighFill));
}

// What a photocopy keeps: medium and unknown are hatched, and no two fills are alike in grey.
TEST(ReportFigures, TellClassesApartWithoutColour) {
  std::vector<double> greys;
  for (const LoadClass load_class : kLoadClassesOfTables) {
    const std::string svg = StateKey(load_class);
    const bool is_hatched = svg.find("<path") != std::string::npos;
    EXPECT_EQ(is_hatched, load_class == LoadClass::kMedium || load_class == LoadClass::kUnknown);
    std::smatch fill;
    ASSERT_TRUE(std::regex_search(svg, fill, std::regex("fill=\"#(..)(..)(..)\"")));
    const auto channel = [&](std::size_t i) { return std::stoi(fill[i], nullptr, 16) / 255.0; };
    greys.push_back(0.299 * channel(1) + 0.587 * channel(2) + 0.114 * channel(3));
  }
  for (std::size_t i = 0; i < greys.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_GT(std::abs(greys[i] - greys[k]), 0.12) << i << k;
  }
}

TEST(SvgDrawing, EscapesTexts) {
  SvgDrawing drawing(10, 5, "<\"a\">");
  drawing.Text(1, 1, "</svg><script>&\x01");
  EXPECT_EQ(urdf::ReadOutline(drawing.Finish()).elements.size(), 2U);
}

TEST(SvgDrawing, KeepsHatchingInsideItsBox) {
  SvgDrawing drawing(10, 10, "");
  drawing.Hatch({2, 3, 4, 1.5}, 0.5, true, {});
  drawing.Hatch({2, 3, 4, 1.5}, 0.5, false, {});
  const std::string svg = drawing.Finish();
  static const std::regex kPoint("[ML]([0-9.]+) ([0-9.]+)");
  std::size_t points = 0;
  for (std::sregex_iterator each(svg.begin(), svg.end(), kPoint), end; each != end; ++each) {
    const double x = std::stod((*each)[1]), y = std::stod((*each)[2]);
    EXPECT_TRUE(x >= 1.99 && x <= 6.01 && y >= 2.99 && y <= 4.51) << x << " " << y;
    ++points;
  }
  EXPECT_GE(points, 40U);
}

}  // namespace
}  // namespace kinescope::app
