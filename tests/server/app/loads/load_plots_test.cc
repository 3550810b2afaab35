// The plots of `kinescope loads`: how many curves, where they break, where the bands lie, and that
// what is written is XML.
#include "server/app/loads/load_plots.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "core/system/errors.h"
#include "server/table/load_rows.h"
#include "tests/full_disk.h"
#include "tests/server/app/loads/trial_scenes.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::app {
namespace {

using render::Plot;
using render::PlotBand;
using render::PlotCurve;
using render::PlotPanel;
using testing::AddTo;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::SceneWithRatio;
using testing::ShortLift;
using ::testing::SizeIs;
using testing::TempFolder;
using testing::TrialOf;

constexpr std::size_t kLowBackIndex = 0, kElbowIndex = 5;  // into kScoredJoints

TrialContext ContextWithLimits(double medium_from, double high_from) {
  TrialContext context;
  context.source = "take.mvnx";
  context.scene.loads.meter.up = {medium_from, high_from};
  return context;
}

std::vector<std::string> CurveNames(const PlotPanel& panel) {
  std::vector<std::string> names;
  for (const PlotCurve& curve : panel.curves) names.push_back(curve.name);
  return names;
}

// The parts between breaks, each as its first and last x.
std::vector<std::pair<double, double>> DrawnParts(const PlotCurve& curve) {
  std::vector<std::pair<double, double>> parts;
  bool is_drawing = false;
  for (const auto& [x, y] : curve.points) {
    if (std::isnan(y)) {
      is_drawing = false;
    } else if (is_drawing) {
      parts.back().second = x;
    } else {
      parts.emplace_back(x, x);
      is_drawing = true;
    }
  }
  return parts;
}

std::vector<std::string> TextsOf(const Plot& plot) {
  std::vector<std::string> texts;
  for (const render::PlotText& text : plot.texts) texts.push_back(text.text);
  return texts;
}

// Every 10 ms from `from` to `to` s.
void AddRatios(LoadTrial& trial, double from, double to, double ratio, std::string_view why = "") {
  for (int i = 0; from + 0.01 * i <= to + 1e-9; ++i) {
    AddTo(trial, SceneWithRatio(from + 0.01 * i, ratio, why));
  }
}

TEST(LoadPlots, ShowTheRatioAndTheMomentsAboutThreeAxesOfAJoint) {
  const LoadTrial trial = TrialOf(ShortLift());
  const Plot plot = JointPlot(trial, TrialContext(), kElbowIndex);
  ASSERT_THAT(plot.panels, SizeIs(2));
  EXPECT_THAT(plot.panels[0].curves, SizeIs(1));
  EXPECT_THAT(CurveNames(plot.panels[1]), ElementsAre("x, forward", "y, left", "z, up"));
  EXPECT_NE(plot.panels[1].curves[0].dash, plot.panels[1].curves[1].dash)
      << "colour alone does not tell them apart in print";
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotCurve& curve : panel.curves) {
      EXPECT_THAT(curve.points, SizeIs(ShortLift().size()));
    }
  }
  for (std::size_t i = 0; i < ShortLift().size(); ++i) {
    const PersonState& person = ShortLift()[i]->people[0];
    const auto& [secs, ratio] = plot.panels[0].curves[0].points[i];
    EXPECT_NEAR(secs, Secs(ShortLift()[i]->stamp_nanos - ShortLift()[0]->stamp_nanos), 1e-9);
    EXPECT_NEAR(ratio, person.loads[kElbowIndex].ratio, 1e-6);
  }
}

TEST(LoadPlots, ShowTheCompressionOfTheLowBack) {
  const LoadTrial trial = TrialOf(ShortLift());
  const Plot plot = JointPlot(trial, TrialContext(), kLowBackIndex);
  ASSERT_THAT(plot.panels, SizeIs(3));
  const PlotPanel& compression = plot.panels[2];
  EXPECT_EQ(compression.y_label, "compression (kN)");
  ASSERT_THAT(compression.curves, SizeIs(1));
  EXPECT_NEAR(compression.curves[0].points.back().second,
              ShortLift().back()->people[0].forces.lumbar->compression / 1000, 1e-6);
  ASSERT_THAT(compression.bands, SizeIs(3));
  EXPECT_DOUBLE_EQ(compression.bands[1].from, 3.4);
  EXPECT_DOUBLE_EQ(compression.bands[2].from, 6.4);
  EXPECT_GT(compression.y_to, 3.4) << "the limit is to be seen";
}

TEST(LoadPlots, HaveQuantityAndUnitAtEveryAxis) {
  const LoadTrial trial = TrialOf(ShortLift());
  for (std::size_t joint = 0; joint < urdf::kScoredJoints.size(); ++joint) {
    const Plot plot = JointPlot(trial, TrialContext(), joint);
    EXPECT_EQ(plot.panels[0].y_label, "load ratio");
    EXPECT_EQ(plot.panels[1].y_label, "moment (N·m)");
    EXPECT_EQ(plot.panels.back().x_label, "time (s)");
    EXPECT_TRUE(plot.panels.back().has_x_numbers);
    for (std::size_t i = 0; i + 1 < plot.panels.size(); ++i) {
      EXPECT_EQ(plot.panels[i].x_label, "") << "one time axis for all of them";
    }
    EXPECT_EQ(plot.texts.at(0).text, ScoredLabel(joint));
    for (const PlotPanel& panel : plot.panels) {
      EXPECT_DOUBLE_EQ(panel.x_from, 0);
      EXPECT_NEAR(panel.x_to, 0.25, 1e-6);
      EXPECT_LE(panel.left + panel.width, plot.width);
      EXPECT_LE(panel.top + panel.height, plot.height);
    }
  }
}

TEST(LoadPlots, HaveBandsAtTheGivenClassLimits) {
  const LoadTrial trial = TrialOf(ShortLift());
  for (const auto& [medium_from, high_from] :
       {std::pair(0.3, 0.6), std::pair(0.1, 0.25), std::pair(2.0, 4.0)}) {
    const TrialContext context = ContextWithLimits(medium_from, high_from);
    const Plot joint = JointPlot(trial, context, kElbowIndex);
    const PlotPanel& panel = joint.panels[0];
    ASSERT_THAT(panel.bands, SizeIs(3));
    EXPECT_EQ(panel.bands[0].from, 0);
    EXPECT_EQ(panel.bands[0].to, medium_from);
    EXPECT_EQ(panel.bands[1].from, medium_from);
    EXPECT_EQ(panel.bands[1].to, high_from);
    EXPECT_EQ(panel.bands[2].from, high_from);
    EXPECT_EQ(panel.bands[0].label, fmt::format("low ≤ {:.2f}", medium_from));
    EXPECT_EQ(panel.bands[2].label, fmt::format("high > {:.2f}", high_from));
    ASSERT_THAT(panel.limits, SizeIs(2));
    EXPECT_EQ(panel.limits[0].y, medium_from);
    EXPECT_EQ(panel.limits[1].y, high_from);
    EXPECT_GT(panel.y_to, high_from) << "all bands are to be seen";
  }
}

TEST(LoadPlots, HaveBandsInPaleColoursOfTheirClasses) {
  const LoadTrial trial = TrialOf(ShortLift());
  const Plot plot = JointPlot(trial, TrialContext(), kElbowIndex);
  const LoadClass classes[] = {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh};
  for (std::size_t i = 0; i < 3; ++i) {
    const Rgb full = ColorOf(classes[i]), tint = plot.panels[0].bands[i].color;
    const double depth = (1 - tint[0]) + (1 - tint[1]) + (1 - tint[2]);
    const double full_depth = (1 - full[0]) + (1 - full[1]) + (1 - full[2]);
    EXPECT_LT(depth, 0.3 * full_depth) << "curves stand out from it";
    for (std::size_t channel = 0; channel < 3; ++channel) {
      EXPECT_NEAR((1 - tint[channel]) / depth, (1 - full[channel]) / full_depth, 1e-9)
          << "another hue than the class has";
    }
  }
}

TEST(LoadPlots, InterruptCurvesAtMissingSamplesAndHatchTheGap) {
  LoadTrial trial(true, 0);
  AddRatios(trial, 0, 1, 0.2);
  AddRatios(trial, 3, 4, 0.2);
  const Plot plot = JointPlot(trial, TrialContext(), kElbowIndex);
  for (const PlotPanel& panel : plot.panels) {
    for (const PlotCurve& curve : panel.curves) {
      const auto parts = DrawnParts(curve);
      ASSERT_THAT(parts, SizeIs(2));
      EXPECT_NEAR(parts[0].second, 1, 1e-9);
      EXPECT_NEAR(parts[1].first, 3, 1e-9);
    }
    ASSERT_THAT(panel.gaps, SizeIs(1));
    EXPECT_NEAR(panel.gaps[0].from, 1.5, 1e-9) << "a sample counts for half a second";
    EXPECT_NEAR(panel.gaps[0].to, 3, 1e-9);
  }
  EXPECT_THAT(TextsOf(plot), ::testing::Contains("unknown: no samples"));
}

TEST(LoadPlots, ShowNoGapForAStepBelowHalfASecond) {
  LoadTrial trial(true, 0);
  AddRatios(trial, 0, 1, 0.2);
  AddRatios(trial, 1.4, 2, 0.2);
  const Plot plot = JointPlot(trial, TrialContext(), kElbowIndex);
  EXPECT_THAT(DrawnParts(plot.panels[0].curves[0]), SizeIs(1));
  EXPECT_THAT(plot.panels[0].gaps, IsEmpty());
  EXPECT_THAT(TextsOf(plot), Each(::testing::Not(HasSubstr("unknown"))));
}

TEST(LoadPlots, InterruptCurvesAtUnknownLoadsAndShowTheReason) {
  LoadTrial trial(true, 0);
  AddRatios(trial, 0, 1, 0.2);
  AddRatios(trial, 1.01, 2, std::numeric_limits<double>::quiet_NaN(), "no foot contact");
  AddRatios(trial, 2.01, 3, 0.2);
  const Plot plot = JointPlot(trial, TrialContext(), kElbowIndex);
  const auto parts = DrawnParts(plot.panels[0].curves[0]);
  ASSERT_THAT(parts, SizeIs(2));
  EXPECT_NEAR(parts[0].second, 1, 1e-9);
  EXPECT_NEAR(parts[1].first, 2.01, 1e-9);
  ASSERT_THAT(plot.panels[0].gaps, SizeIs(1));
  EXPECT_NEAR(plot.panels[0].gaps[0].from, 1.01, 1e-9);
  EXPECT_THAT(TextsOf(plot), ::testing::Contains("unknown: no foot contact (1.00 s)"));
  const auto& timeline = plot.panels[0].class_timeline;
  ASSERT_THAT(timeline, SizeIs(3));
  EXPECT_EQ(timeline[0].load_class, LoadClass::kLow);
  EXPECT_EQ(timeline[1].load_class, LoadClass::kUnknown);
  EXPECT_EQ(timeline[2].load_class, LoadClass::kLow);
}

TEST(LoadPlots, MarkThePeakAndLeaveRoomAboveIt) {
  LoadTrial trial(true, 0);
  AddRatios(trial, 0, 1, 0.2);
  SceneState peak = SceneWithRatio(1.01, 1.7);
  peak.people[0].loads[kElbowIndex].channel = "flexion";
  AddTo(trial, peak);
  AddRatios(trial, 1.02, 2, 0.2);
  const PlotPanel panel = JointPlot(trial, TrialContext(), kElbowIndex).panels[0];
  ASSERT_THAT(panel.marks, SizeIs(1));
  EXPECT_NEAR(panel.marks[0].x, 1.01, 1e-9);
  EXPECT_NEAR(panel.marks[0].y, 1.7, 1e-9);
  EXPECT_EQ(panel.marks[0].label, "1.70 flexion");
  EXPECT_GT(panel.y_to, 1.7);
}

TEST(LoadPlots, AcceptASingleSample) {
  LoadTrial trial(true, 0);
  AddTo(trial, SceneWithRatio(0, 0.2));
  EXPECT_THAT(render::ToSvg(JointPlot(trial, TrialContext(), kLowBackIndex)), HasSubstr("</svg>"));
}

// Through the parser that urdfdom's input goes through.
TEST(LoadPlots, AreValidXmlForAnyNameOfPersonAndFile) {
  testing::Scenes scenes = ShortLift();
  auto named = std::make_shared<SceneState>(*scenes.back());
  named->people[0].name = "<b>\"Anna\" & Bob\x01\x1b \xFF\xC0 ]]>";
  scenes.back() = named;
  const LoadTrial trial = TrialOf(scenes);
  TrialContext context;
  context.source = "a<b>&\"c\x02\xFE.mvnx";
  const Plot plot = JointPlot(trial, context, kElbowIndex);
  const urdf::XmlOutline svg = urdf::ReadOutline(render::ToSvg(plot));
  EXPECT_EQ(svg[0].tag, "svg");
  ASSERT_NE(svg[0].Attribute("width"), nullptr);
  EXPECT_EQ(std::stod(*svg[0].Attribute("width")), plot.width);
}

// The curves arrive in the file as paths: the whole line of x, the dashed one of y, the dots of z.
TEST(LoadPlots, ContainOneSvgPathPerCurve) {
  const LoadTrial trial = TrialOf(ShortLift());
  const auto paths_with = [](const std::string& svg, const std::string& dash) {
    const urdf::XmlOutline outline = urdf::ReadOutline(svg);
    return std::count_if(outline.elements.begin(), outline.elements.end(), [&](const auto& e) {
      const std::string* style = e.Attribute("style");
      const std::string* own = e.Attribute("stroke-dasharray");
      return e.tag == "path" &&
             ((own != nullptr && own->rfind(dash, 0) == 0) ||
              (style != nullptr && style->find("stroke-dasharray:" + dash) != std::string::npos));
    });
  };
  const std::string svg = render::ToSvg(JointPlot(trial, TrialContext(), kElbowIndex));
  EXPECT_EQ(paths_with(svg, "5"), 2) << "y: the curve and its sample in the legend";
  EXPECT_EQ(paths_with(svg, "1.2"), 2) << "of z";
  EXPECT_EQ(paths_with(svg, "3"), 2) << "the limits of the classes";
}

template <class Error>
std::string WritePlotsError(const LoadTrial& trial, const std::filesystem::path& folder) {
  std::map<int, LoadTrial> trials;
  trials.emplace(0, trial);
  try {
    WritePlots(trials, TrialContext(), folder);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(LoadPlots, NameTheFileAndTheReasonWhenTheDiskIsFull) {
  const TempFolder folder;
  const testing::SmallFilesOnly full(1000);
  EXPECT_THAT(WritePlotsError<std::runtime_error>(TrialOf(ShortLift()), folder / "plots"),
              ::testing::AllOf(HasSubstr((folder / "plots" / "l5_s1.svg").string()),
                               ::testing::EndsWith(": File too large")));
  EXPECT_THAT(std::filesystem::is_empty(folder / "plots"), true);
}

TEST(LoadPlots, NameAFolderThatCannotBeCreated) {
  const TempFolder folder;
  std::ofstream(folder / "file") << "not a folder";
  const auto inside = folder / "file" / "plots";
  EXPECT_THAT(WritePlotsError<UsageError>(TrialOf(ShortLift()), inside),
              HasSubstr("--plots=" + inside.string() + ": "));
}

}  // namespace
}  // namespace kinescope::app
