#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/compression_limits.h"
#include "render/plot.h"
#include "server/app/loads/report_figures.h"
#include "server/app/loads/report_finding.h"
#include "server/app/loads/report_text.h"
#include "server/app/loads/svg.h"
#include "server/app/loads/timeline_rows.h"
#include "server/loads/gap.h"
#include "server/loads/joint_score.h"

namespace kinescope::app {
namespace {

constexpr double kAxisLeft = 17,
                 kAxisRight = kTimeFigureWidthMm - 10;  // between row names and limits
constexpr double kCurveTop = 3.6, kTimeAxisHeight = 4.2;
constexpr double kMarkPt = 7.5;  // bold is wider than its 7.1 pt
constexpr Rgb kGridInk = {0.86, 0.87, 0.89}, kBandInk = {0.80, 0.82, 0.84};

TimeScale ScaleOf(const LoadTrial& trial) {
  constexpr double kShortest = 1e-3;  // s, of a recording of one sample
  const double from = trial.SecsOf(trial.curves().front().stamp_nanos);
  return {from, std::max(from + kShortest, trial.SecsOf(trial.curves().back().stamp_nanos)),
          kAxisLeft, kAxisRight};
}

// Minutes in long trials.
void DrawTimeAxis(const TimeScale& scale, double bottom, SvgDrawing& drawing) {
  constexpr double kSecsPerMin = 60, kLongSecs = 600;
  constexpr int kMostTicks = 9;
  const double unit = scale.to - scale.from > kLongSecs ? kSecsPerMin : 1;
  const double from = scale.from / unit, to = scale.to / unit;
  constexpr double kShortSecs = 0.01;  // of a few samples: numbers would need too many digits
  for (const double tick : render::NiceTicks(from, to, kMostTicks)) {
    const bool is_left_out = scale.to - scale.from < kShortSecs && tick > from;
    const double rounding = 0.01 * (to - from);  // a person may appear a little later than another
    if (tick < from - rounding || tick > to + rounding || is_left_out) continue;
    const double x = std::clamp(scale.X(tick * unit), scale.left, scale.right);
    drawing.Line({{x, kCurveTop}, {x, bottom}}, {kGridInk, 0.12, ""});
    drawing.Text(x, bottom + 3.2, fmt::format("{:g}", tick + 0.0), {SvgAnchor::kMiddle});
  }
  drawing.Text(kAxisRight + 2.2, bottom + 3.2, unit > 1 ? "min" : "s");
}

SvgDrawing::Points CompressionPoints(const LoadTrial& trial) {
  constexpr double kNewtonsPerKilo = 1000;
  constexpr double kBreak = std::numeric_limits<double>::quiet_NaN();
  SvgDrawing::Points points;
  for (const TrialSample& sample : trial.curves()) {
    const double secs = trial.SecsOf(sample.stamp_nanos);
    if (!points.empty() && secs < points.back().first) continue;
    if (!points.empty() && secs - points.back().first > loads::kLongestGapSecs) {
      points.emplace_back(points.back().first, kBreak);
    }
    points.emplace_back(secs, sample.compression / kNewtonsPerKilo);
  }
  return points;
}

class CompressionDrawing {
 public:
  CompressionDrawing(const LoadTrial& trial, const TimeScale& scale, double bottom)
      : trial_(trial), scale_(scale), bottom_(bottom) {
    const double peak = trial.compression().count > 0 ? trial.compression().most / kKilo : 0;
    top_kn_ =
        std::max(1.08 * kCompressionLimits[1] / kKilo, 1.05 * (1 + kCompressionUncertainty) * peak);
  }

  void Draw(SvgDrawing& drawing) const {
    constexpr int kMostTicks = 4;
    for (const double tick : render::NiceTicks(0, top_kn_, kMostTicks)) {
      if (tick > top_kn_) continue;
      drawing.Line({{kAxisLeft, Y(tick)}, {kAxisRight, Y(tick)}}, {kGridInk, 0.12, ""});
      drawing.Text(kAxisLeft - 1, Y(tick) + 0.9, fmt::format("{:g}", tick + 0.0),
                   {SvgAnchor::kEnd});
    }
    DrawCurve(drawing);
    for (const double limit : kCompressionLimits) {
      const double y = Y(limit / kKilo);
      drawing.Line({{kAxisLeft, y}, {kAxisRight, y}}, {{1, 1, 1}, 0.5, ""});  // over dense curves
      drawing.Line({{kAxisLeft, y}, {kAxisRight, y}}, {SvgStroke().color, 0.22, "1.2 0.8"});
      drawing.Text(kAxisRight + 0.6, y + 0.9, fmt::format("{:g} N", limit),
                   {SvgAnchor::kStart, true});
    }
    if (trial_.compression().count == 0) {
      drawing.Text((kAxisLeft + kAxisRight) / 2, (kCurveTop + bottom_) / 2, "unknown",
                   {SvgAnchor::kMiddle});
      return;
    }
    DrawPeak(drawing);
  }

 private:
  static constexpr double kKilo = 1000;

  double Y(double kilonewtons) const {
    return bottom_ - std::max(kilonewtons, 0.0) / top_kn_ * (bottom_ - kCurveTop);
  }

  void DrawCurve(SvgDrawing& drawing) const {
    constexpr int kColumns = 320;  // of about 0.2 mm
    SvgDrawing::Points curve, upper, lower;
    const auto end_area = [&] {
      upper.insert(upper.end(), lower.rbegin(), lower.rend());
      drawing.Area(upper, kBandInk);
      upper.clear();
      lower.clear();
    };
    for (const auto& [secs, kilonewtons] :
         render::Thinned(CompressionPoints(trial_), scale_.from, scale_.to, kColumns)) {
      const double x = scale_.X(secs);
      if (!std::isfinite(kilonewtons)) {
        end_area();
        curve.emplace_back(x, kilonewtons);
        continue;
      }
      curve.emplace_back(x, Y(kilonewtons));
      upper.emplace_back(x, Y((1 + kCompressionUncertainty) * kilonewtons));
      lower.emplace_back(x, Y((1 - kCompressionUncertainty) * kilonewtons));
    }
    end_area();
    drawing.Line(curve, {SvgStroke().color, 0.35, ""});
  }

  void DrawPeak(SvgDrawing& drawing) const {
    const Peak& peak = trial_.compression();
    const double secs = trial_.SecsOf(peak.at_nanos), x = scale_.X(secs);
    const double kilonewtons = peak.most / kKilo;
    const std::string label = fmt::format("{:.0f} N at {:.2f} s", peak.most, secs);
    constexpr double kTextPt = 7.5;  // bold is wider than its 7.1 pt
    const double half = TextWidthMm(label, kTextPt) / 2;
    const double middle = std::clamp(x, kAxisLeft + half + 1, kAxisRight - half - 1);
    double baseline =
        std::max(Y((1 + kCompressionUncertainty) * kilonewtons) - 0.8, kCurveTop + kSvgTextMm);
    for (const double limit : kCompressionLimits) {  // not across a line
      const double line = Y(limit / kKilo);
      if (line < baseline - kSvgTextMm || line > baseline + 0.5) continue;
      const bool fits_above = line - 0.7 - kSvgTextMm > kCurveTop;
      baseline = fits_above ? line - 0.7 : line + kSvgTextMm;
    }
    drawing.Fill({middle - half - 0.4, baseline - 2.2, 2 * half + 0.8, 2.7}, {1, 1, 1});
    drawing.Dot(x, Y(kilonewtons), 0.6, true);
    drawing.Text(middle, baseline, label, {SvgAnchor::kMiddle, true});
  }

  const LoadTrial& trial_;
  const TimeScale& scale_;
  double bottom_, top_kn_ = 1;
};

// Numbers as in the list below the figure; those that would overlap are left out.
void DrawMarks(const std::vector<TrialMark>& marks, const TimeScale& scale, double bottom,
               SvgDrawing& drawing) {
  const SvgStroke stroke = {render::kFlagInk, 0.25, "1.4 0.5"};
  constexpr double kApart = 0.3;  // mm; nearer lines would be one
  double free_from = kAxisLeft, last = -1;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double from = scale.X(std::clamp(marks[i].from_secs, scale.from, scale.to));
    const double to = scale.X(std::clamp(marks[i].to_secs, scale.from, scale.to));
    if (from < last + kApart && to < last + kApart) continue;
    last = from;
    drawing.Line({{from, kCurveTop}, {from, bottom}}, stroke);
    if (to > from) {
      drawing.Line({{to, kCurveTop}, {to, bottom}}, stroke);
      drawing.Line({{from, kCurveTop}, {to, kCurveTop}}, {render::kFlagInk, 0.5, ""});
    }
    const std::string number = std::to_string(i + 1);
    const double width = TextWidthMm(number, kMarkPt) + 0.8;
    const double left = from + width > kAxisRight ? from - width : from;
    if (left < free_from) continue;
    drawing.Fill({left, kCurveTop, width, 3}, {1, 1, 1});
    drawing.Text(left + 0.4, kCurveTop + 2.4, number, {SvgAnchor::kStart, true, render::kFlagInk});
    free_from = left + width + 0.4;
  }
}

}  // namespace

std::string TimeFigure(const LoadTrial& trial, const TrialContext& context, double height_mm) {
  const TimeScale scale = ScaleOf(trial);
  const std::vector<TimelineRow> rows = TimelineRowsOf(trial);
  const double rows_bottom = height_mm - kTimeAxisHeight;
  const double rows_top = rows_bottom - kTimelinePitchMm * static_cast<double>(rows.size());
  SvgDrawing drawing(
      kTimeFigureWidthMm, height_mm,
      fmt::format("Compression at L5/S1 over time, and times above a ratio of {:.2f}",
                  context.scene.loads.meter.up[1]));
  DrawTimeAxis(scale, rows_bottom, drawing);
  const bool has_shares = std::any_of(rows.begin(), rows.end(), ShowsShares);
  drawing.Text(kAxisLeft, kCurveTop - 1,
               fmt::format("L5/S1 compression, kN; grey: ±{:g} %{}", 100 * kCompressionUncertainty,
                           has_shares ? "; below: height is share of time" : ""));
  CompressionDrawing(trial, scale, rows_top - 1.6).Draw(drawing);
  DrawMarks(context.marks, scale, rows_bottom, drawing);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    DrawRow(rows[i], rows_top + kTimelinePitchMm * static_cast<double>(i), scale, drawing);
  }
  drawing.Line({{kAxisLeft, rows_bottom}, {kAxisRight, rows_bottom}}, {});
  return drawing.Finish();
}

}  // namespace kinescope::app
