#include "server/app/loads/load_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/compression_limits.h"
#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "core/unknown.h"
#include "render/image/new_file.h"
#include "render/image/png_file.h"
#include "server/app/loads/report_text.h"
#include "server/app/loads/trial_intervals.h"
#include "server/loads/gap.h"
#include "server/loads/joint_score.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

using render::Plot;
using render::PlotCurve;
using render::PlotPanel;
using Points = std::vector<std::pair<double, double>>;

// Blue and vermilion of the palette by M. Okabe and K. Ito (2008), which all eyes tell apart, and a
// grey; the dashes tell them apart in print.
constexpr Rgb kBlue = {0.00, 0.45, 0.70}, kVermilion = {0.84, 0.37, 0.00},
              kGrey = {0.35, 0.35, 0.35}, kInk = {0.13, 0.15, 0.19}, kFaint = {0.38, 0.41, 0.46};

Rgb Tint(LoadClass load_class) {
  Rgb color = ColorOf(load_class);
  for (double& channel : color) channel = 1 - 0.22 * (1 - channel);
  return color;
}

void SetTime(const LoadTrial& trial, PlotPanel& panel) {
  constexpr double kShortest = 1e-3;  // s, of a recording of one sample
  panel.x_from = trial.SecsOf(trial.curves().front().stamp_nanos);
  panel.x_to = std::max(trial.SecsOf(trial.curves().back().stamp_nanos), panel.x_from + kShortest);
}

// value(sample) over time; broken where it is not known and where samples are missing.
template <class Value>
Points CurveOf(const LoadTrial& trial, Value&& value) {
  Points points;
  for (const TrialSample& sample : trial.curves()) {
    const double secs = trial.SecsOf(sample.stamp_nanos);
    if (!points.empty() &&
        (secs < points.back().first || secs - points.back().first > loads::kLongestGapSecs)) {
      points.emplace_back(points.back().first, kUnknown);
    }
    if (points.empty() || secs >= points.back().first) points.emplace_back(secs, value(sample));
  }
  return points;
}

std::vector<render::PlotClassInterval> ClassTimelineOf(const LoadTrial& trial, std::size_t joint) {
  std::vector<render::PlotClassInterval> timeline;
  for (const auto& [from, to, load_class] :
       IntervalsOf(trial, LoadClass::kUnknown,
                   [joint](const TrialSample& sample) { return sample.joints[joint].band; })) {
    timeline.push_back({from, to, load_class});
  }
  return timeline;
}

void SetRatio(const LoadTrial& trial, const TrialContext& context, std::size_t joint,
              PlotPanel& panel) {
  SetTime(trial, panel);
  const auto& up = context.scene.loads.meter.up;
  constexpr double kEnd = 1e9;
  panel.bands = {{0, up[0], Tint(LoadClass::kLow), fmt::format("low ≤ {:.2f}", up[0])},
                 {up[0], up[1], Tint(LoadClass::kMedium), "medium"},
                 {up[1], kEnd, Tint(LoadClass::kHigh), fmt::format("high > {:.2f}", up[1])}};
  panel.limits = {{up[0], ""}, {up[1], ""}};
  PlotCurve curve;
  curve.color = kInk;
  curve.points = CurveOf(trial, [joint](const TrialSample& sample) {
    const TrialSample::Joint& of = sample.joints[joint];
    return of.band == LoadClass::kUnknown ? kUnknown : static_cast<double>(of.ratio);
  });
  panel.curves = {std::move(curve)};
  panel.class_timeline = ClassTimelineOf(trial, joint);
  for (const render::PlotClassInterval& interval : panel.class_timeline) {
    if (interval.load_class != LoadClass::kUnknown) continue;
    panel.gaps.push_back({interval.from, interval.to});
  }
}

// The limits, and room above the highest of the curves.
double RatioTop(double peak, const TrialContext& context) {
  const double least = 1.25 * context.scene.loads.meter.up[1];
  return std::isfinite(peak) ? std::max(least, 1.1 * peak) : least;
}

void SetRange(PlotPanel& panel) {
  double low = 0, high = 0;
  for (const PlotCurve& curve : panel.curves) {
    for (const auto& [x, y] : curve.points) {
      if (std::isnan(y)) continue;
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  const double room = std::max(0.08 * (high - low), 0.5);
  panel.has_y_numbers = high > low;  // there is something to read off
  panel.y_from = low < 0 ? low - room : 0;
  panel.y_to = high + room;
}

PlotPanel MomentPanel(const LoadTrial& trial, std::size_t joint) {
  PlotPanel panel;
  SetTime(trial, panel);
  panel.y_label = "moment (N·m)";
  const char* const names[] = {"x, forward", "y, left", "z, up"};
  const Rgb colors[] = {kBlue, kVermilion, kGrey};
  const std::vector<double> dashes[] = {{}, {5, 2}, {1.2, 1.5}};
  for (int axis = 0; axis < 3; ++axis) {
    PlotCurve curve;
    curve.name = names[axis];
    curve.color = colors[axis];
    curve.dash = dashes[axis];
    curve.points = CurveOf(trial, [joint, axis](const TrialSample& sample) {
      return static_cast<double>(sample.joints[joint].moment[axis]);
    });
    panel.curves.push_back(std::move(curve));
  }
  SetRange(panel);
  return panel;
}

PlotPanel CompressionPlot(const LoadTrial& trial) {
  constexpr double kNewtonsPerKilo = 1000;
  PlotPanel panel;
  SetTime(trial, panel);
  const double action = kCompressionLimits[0] / kNewtonsPerKilo;
  const double upper = kCompressionLimits[1] / kNewtonsPerKilo;
  constexpr double kEnd = 1e9;
  panel.bands = {{-kEnd, action, Tint(LoadClass::kLow), "low"},
                 {action, upper, Tint(LoadClass::kMedium), fmt::format("> {:g} kN", action)},
                 {upper, kEnd, Tint(LoadClass::kHigh), fmt::format("> {:g} kN", upper)}};
  panel.limits = {{action, ""}, {upper, ""}};
  PlotCurve curve;
  curve.color = kInk;
  curve.points = CurveOf(trial, [](const TrialSample& sample) {
    return static_cast<double>(sample.compression) / kNewtonsPerKilo;
  });
  panel.curves = {std::move(curve)};
  SetRange(panel);
  panel.y_to = std::max(panel.y_to, 1.15 * action);
  return panel;
}

std::string Described(const LoadTrial& trial, const TrialContext& context) {
  std::string text = context.source;
  if (!trial.newest().name.empty()) text += ", " + trial.newest().name;
  for (const Fact& fact : FactsOf(trial, context)) {
    if (fact.label == "hand load" && fact.is_assumed) continue;
    const bool is_method = fact.label == "body table" || fact.label == "load mode" ||
                           fact.label == "load metric" || fact.label == "floor";
    if (is_method) continue;
    const bool needs_label = fact.label == "hand load" || fact.label == "added mass";
    text += fmt::format(", {}{}{}", needs_label ? fact.label + " " : "", fact.value,
                        fact.is_assumed ? " (assumed)" : "");
  }
  return text;
}

void AddReasons(const LoadTrial& trial, std::size_t joint, double x, double y, Plot& plot) {
  std::string text;
  for (const auto& [why, secs] : trial.why_unknown(joint)) {
    text += fmt::format("{}{} ({:.2f} s)", text.empty() ? "" : "; ", why, secs);
  }
  if (text.empty() && plot.panels[0].gaps.empty()) return;
  plot.swatches.push_back({x, y - 7, 14, 8, {}, true});
  plot.texts.push_back({x + 19, y, "unknown: " + (text.empty() ? std::string("no samples") : text),
                        7.5, false, kFaint});
}

// As much of a line of small text as is right of the axis.
std::string FittingLine(const std::string& text) {
  constexpr double kSize = 7.5, kRoomMm = 150;
  constexpr double kWiderFont = 1.2;  // DejaVu Sans than Arial
  return Shortened(text, kWiderFont * kSize, kRoomMm);
}

// Below the plot.
void AddMarkNames(const std::vector<TrialMark>& marks, double left, Plot& plot) {
  constexpr double kSize = 7.5, kLine = 10;
  constexpr std::size_t kMost = 20;
  const std::size_t shown = marks.size() > kMost ? kMost - 1 : marks.size();
  const auto add = [&](const std::string& line) {
    plot.texts.push_back({left, plot.height, FittingLine(line), kSize, false, kInk});
    plot.height += kLine;
  };
  for (std::size_t i = 0; i < shown; ++i) {
    add(fmt::format("{}  {}: {}", i + 1, TimesText(marks[i]), marks[i].text));
  }
  if (shown < marks.size()) add(fmt::format("and {} more", marks.size() - shown));
}

}  // namespace

Plot JointPlot(const LoadTrial& trial, const TrialContext& context, std::size_t joint) {
  constexpr double kLeft = 50, kWidth = 352;
  Plot plot;
  plot.width = 480;
  plot.texts = {{kLeft, 20, std::string(ScoredLabel(joint)), 12, true, kInk},
                {kLeft, 33, FittingLine(Described(trial, context)), 7.5, false, kFaint}};

  PlotPanel ratio;
  ratio.left = kLeft;
  ratio.width = kWidth;
  ratio.top = 44;
  ratio.height = 130;
  ratio.y_label = "load ratio";
  ratio.has_x_numbers = false;
  SetRatio(trial, context, joint, ratio);
  const loads::JointExposure exposure = trial.exposure().Of(joint);
  ratio.y_to = RatioTop(exposure.peak_ratio, context);
  if (std::isfinite(exposure.peak_ratio)) {
    ratio.marks.push_back({trial.SecsOf(exposure.peak_stamp_nanos), exposure.peak_ratio,
                           fmt::format("{:.2f} {}", exposure.peak_ratio, exposure.peak_channel)});
  }
  for (std::size_t i = 0; i < context.marks.size(); ++i) {
    const TrialMark& mark = context.marks[i];
    ratio.flags.push_back({mark.from_secs, mark.to_secs, std::to_string(i + 1)});
  }
  plot.panels.push_back(std::move(ratio));

  double bottom = 44 + 130 + 12;
  const auto add = [&](PlotPanel panel) {
    panel.left = kLeft;
    panel.width = kWidth;
    panel.top = bottom + 22;
    panel.height = 76;
    panel.has_x_numbers = false;
    panel.gaps = plot.panels[0].gaps;
    panel.flags = plot.panels[0].flags;
    for (render::PlotFlag& flag : panel.flags) flag.label.clear();
    bottom = panel.top + panel.height;
    plot.panels.push_back(std::move(panel));
  };
  add(MomentPanel(trial, joint));
  if (joint == urdf::kScoredL5S1) {
    PlotPanel compression = CompressionPlot(trial);
    compression.y_label = "compression (kN)";
    add(std::move(compression));
  }
  plot.panels.back().has_x_numbers = true;
  plot.panels.back().x_label = "time (s)";
  AddReasons(trial, joint, kLeft, bottom + 38, plot);
  plot.height = bottom + 46;
  AddMarkNames(context.marks, kLeft, plot);
  return plot;
}

void WritePlots(const std::map<int, LoadTrial>& trials, const TrialContext& context,
                const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) {
    throw UsageError(fmt::format("--plots={}: {}", folder.string(), error.message()));
  }
  constexpr double kDotsPerInch = 200, kPointsPerInch = 72;
  for (const auto& [character, trial] : trials) {
    const std::string person = trials.size() > 1 ? fmt::format("person_{}_", character) : "";
    for (std::size_t joint = 0; joint < urdf::kScoredJoints.size(); ++joint) {
      if (StopRequested()) throw std::runtime_error("interrupted; not all plots were written");
      const Plot plot = JointPlot(trial, context, joint);
      const auto stem = folder / (person + std::string(ScoredName(joint)));
      render::WriteNewFile(stem.string() + ".svg", render::ToSvg(plot));
      render::WritePng(stem.string() + ".png", render::ToImage(plot, kDotsPerInch / kPointsPerInch),
                       {{"Software", "Kinescope " KINESCOPE_VERSION}, {"Source", context.source}});
    }
  }
}

}  // namespace kinescope::app
