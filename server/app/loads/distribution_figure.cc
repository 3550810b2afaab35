#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "server/app/loads/report_figures.h"
#include "server/app/loads/report_text.h"
#include "server/app/loads/svg.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

constexpr double kNumbersWidth = 6;  // of the percents, left of the first panel
constexpr double kPanelTop = 3.4, kPanelHeight = 17, kPanelGap = 2.6;
constexpr double kRatioNumbersHeight = 3.4;
constexpr std::array<double, 3> kShownPercents = {10, 50, 90};
constexpr Rgb kPaleInk = {0.92, 0.925, 0.935}, kThinInk = {0.82, 0.83, 0.85};

struct DistributionPanel {
  const char* title;
  std::size_t right;                // or the only one
  std::optional<std::size_t> left;  // index into kScoredJoints
};

constexpr std::array<DistributionPanel, 9> kDistributionPanels = {{{"L5/S1", 0, {}},
                                                                   {"T9/T8", 1, {}},
                                                                   {"Neck", 2, {}},
                                                                   {"Shoulders", 3, 4},
                                                                   {"Elbows", 5, 6},
                                                                   {"Wrists", 7, 8},
                                                                   {"Hips", 9, 10},
                                                                   {"Knees", 11, 12},
                                                                   {"Ankles", 13, 14}}};

// The ratio that a percentage of the known samples do not exceed, by percent from 0 to 100.
std::vector<double> PercentilesOf(const LoadTrial& trial, std::size_t joint) {
  std::vector<double> ratios;
  for (const TrialSample& sample : trial.curves()) {
    const TrialSample::Joint& of = sample.joints[joint];
    if (of.band != LoadClass::kUnknown && std::isfinite(of.ratio)) ratios.push_back(of.ratio);
  }
  std::sort(ratios.begin(), ratios.end());
  std::vector<double> percentiles;
  if (ratios.empty()) return percentiles;
  for (std::size_t percent = 0; percent <= 100; ++percent) {
    const std::size_t rank = (percent * ratios.size() + 99) / 100;  // nearest rank
    percentiles.push_back(ratios[std::max<std::size_t>(rank, 1) - 1]);
  }
  return percentiles;
}

// Of all panels, so that they can be compared: room for every P90.
double HighestShownRatio(const LoadTrial& trial, const TrialContext& context) {
  constexpr double kLeast = 1.2, kMost = 4;
  double highest = std::max(kLeast, 1.3 * context.scene.loads.meter.up[1]);
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    const double p90 = trial.exposure().Of(i).p90;
    if (std::isfinite(p90)) highest = std::max(highest, 1.1 * p90);
  }
  return std::min(highest, kMost);
}

class PanelDrawing {
 public:
  PanelDrawing(double left, double width, double highest, SvgDrawing& drawing)
      : left_(left), width_(width), highest_(highest), drawing_(drawing) {}

  void DrawAxes(const std::array<double, 2>& limits) {
    drawing_.Fill({X(limits[1]), kPanelTop, X(highest_) - X(limits[1]), kPanelHeight}, kPaleInk);
    for (const double percent : kShownPercents) {
      drawing_.Line({{left_, Y(percent)}, {left_ + width_, Y(percent)}}, {kThinInk, 0.1, ""});
    }
    double next_x = left_;
    for (const double ratio : {limits[0], limits[1], 1.0}) {
      if (ratio > highest_) continue;
      if (ratio < 1 || limits[1] >= 1) {
        drawing_.Line({{X(ratio), kPanelTop}, {X(ratio), Y(0)}},
                      {SvgStroke().color, 0.14, "0.5 0.5"});
      }
      std::string number = fmt::format("{:g}", ratio);
      if (number.size() > 1 && number[0] == '0') number.erase(0, 1);
      const double half = TextWidthMm(number, 7.1) / 2;
      if (X(ratio) - half < next_x) continue;
      next_x = X(ratio) + half + 0.6;
      drawing_.Text(X(ratio), Y(0) + 2.9, number, {SvgAnchor::kMiddle});
    }
    drawing_.Line({{left_, kPanelTop}, {left_, Y(0)}, {left_ + width_, Y(0)}}, {});
  }

  void DrawCurve(const LoadTrial& trial, std::size_t joint, bool is_left) {
    SvgDrawing::Points points;
    const std::vector<double> percentiles = PercentilesOf(trial, joint);
    for (std::size_t percent = 0; percent < percentiles.size(); ++percent) {
      const double ratio = percentiles[percent];
      points.emplace_back(X(std::min(ratio, highest_)), Y(static_cast<double>(percent)));
      if (ratio > highest_) break;
    }
    drawing_.Line(points, {SvgStroke().color, 0.32, is_left ? "0.9 0.6" : ""});
    if (percentiles.empty()) return;
    for (const double percent : kShownPercents) {
      const double ratio = percentiles[static_cast<std::size_t>(percent)];
      if (ratio <= highest_) drawing_.Dot(X(ratio), Y(percent), 0.5, !is_left);
    }
  }

  void DrawUnknown() {
    const SvgBox all = {left_ + 0.1, kPanelTop, width_ - 0.1, kPanelHeight - 0.1};
    DrawState(all, LoadClass::kUnknown, drawing_);
    const double middle = kPanelTop + kPanelHeight / 2;
    drawing_.Fill({left_ + 2, middle - 2, width_ - 4, 3.2}, {1, 1, 1});
    drawing_.Text(left_ + width_ / 2, middle + 0.5, "unknown", {SvgAnchor::kMiddle});
  }

 private:
  double X(double ratio) const { return left_ + ratio / highest_ * width_; }
  static double Y(double percent) { return kPanelTop + (1 - percent / 100) * kPanelHeight; }

  double left_, width_, highest_;
  SvgDrawing& drawing_;
};

}  // namespace

std::string DistributionFigure(const LoadTrial& trial, const TrialContext& context) {
  SvgDrawing drawing(kDistributionWidthMm, kPanelTop + kPanelHeight + kRatioNumbersHeight,
                     "Amplitude distribution of the load ratio of each joint");
  const double highest = HighestShownRatio(trial, context);
  constexpr double kPitch =
      (kDistributionWidthMm - kNumbersWidth + kPanelGap) / kDistributionPanels.size();
  for (const double percent : kShownPercents) {
    const double y = kPanelTop + (1 - percent / 100) * kPanelHeight;
    drawing.Text(kNumbersWidth - 0.8, y + 0.9, fmt::format("{:g}", percent), {SvgAnchor::kEnd});
  }
  for (std::size_t i = 0; i < kDistributionPanels.size(); ++i) {
    const DistributionPanel& of = kDistributionPanels[i];
    const double left = kNumbersWidth + static_cast<double>(i) * kPitch;
    drawing.Text(left, kPanelTop - 0.9, of.title, {SvgAnchor::kStart, true});
    PanelDrawing panel(left, kPitch - kPanelGap, highest, drawing);
    panel.DrawAxes(context.scene.loads.meter.up);
    panel.DrawCurve(trial, of.right, false);
    if (of.left) panel.DrawCurve(trial, *of.left, true);
    const bool is_known = trial.exposure().IsEverKnown(of.right) ||
                          (of.left && trial.exposure().IsEverKnown(*of.left));
    if (!is_known) panel.DrawUnknown();
  }
  return drawing.Finish();
}

std::string ShareBar(const loads::JointExposure& exposure, double width_mm) {
  const SvgBox frame = {0.05, 0.05, width_mm - 0.1, 2.4};
  std::uint64_t all = 0;
  for (const std::uint64_t samples : exposure.samples) all += samples;
  std::string description;
  for (const LoadClass band : kLoadClassesOfTables) {
    description += fmt::format("{}{} {} %", description.empty() ? "" : ", ", Name(band),
                               PercentText(exposure.samples[static_cast<std::size_t>(band)], all));
  }
  SvgDrawing drawing(width_mm, 2.5, description);
  double left = frame.left;
  for (const LoadClass band : kLoadClassesOfTables) {
    const std::uint64_t samples = exposure.samples[static_cast<std::size_t>(band)];
    if (samples == 0) continue;
    const double width = frame.width * static_cast<double>(samples) / static_cast<double>(all);
    DrawState({left, frame.top, width, frame.height}, band, drawing);
    left += width;
  }
  drawing.Outline(frame, {SvgStroke().color, 0.1, ""});
  return drawing.Finish();
}

std::string StateKey(LoadClass load_class) {
  constexpr SvgBox kKey = {0.05, 0.05, 3.9, 2.1};
  SvgDrawing drawing(4, 2.2, Name(load_class));
  DrawState(kKey, load_class, drawing);
  drawing.Outline(kKey, {SvgStroke().color, 0.1, ""});
  return drawing.Finish();
}

}  // namespace kinescope::app
