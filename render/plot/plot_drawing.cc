#include "render/plot/plot_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "render/plot/pen.h"

namespace kinescope::render::plot {
namespace {

constexpr Rgb kInk = {0.13, 0.15, 0.19}, kFaint = {0.38, 0.41, 0.46}, kGrid = {0.88, 0.89, 0.91};
constexpr double kTimelineHeight = 9, kTimelineGap = 2.5, kTick = 2.5;  // pt

// So many decimals as tell neighbours apart, and no "-0".
std::string TickText(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(-std::floor(std::log10(step) + 1e-9)), 0, 6);
  const double rounded = std::abs(value) < step * 1e-6 ? 0 : value;
  return fmt::format("{:.{}f}", rounded, decimals);
}

// With less than two there is no scale to read.
std::vector<double> TicksOf(double from, double to, double length, double apart) {
  int most = std::max(2, static_cast<int>(length / apart));
  std::vector<double> ticks = NiceTicks(from, to, most);
  while (ticks.size() < 2) ticks = NiceTicks(from, to, ++most);
  return ticks;
}

class PanelDrawing {
 public:
  PanelDrawing(const PlotPanel& panel, Pen& pen) : p_(panel), pen_(pen) {
    KINESCOPE_CHECK(p_.x_from < p_.x_to && p_.y_from < p_.y_to);
  }

  void Draw() {
    Ground();
    Limits();
    Curves();
    ClassTimeline();
    Axes();
    Legend();
    Flags();
    Marks();
  }

 private:
  double X(double x) const { return p_.left + (x - p_.x_from) / (p_.x_to - p_.x_from) * p_.width; }
  double Y(double y) const { return p_.top + (p_.y_to - y) / (p_.y_to - p_.y_from) * p_.height; }
  double bottom() const { return p_.top + p_.height; }
  double timeline_top() const { return bottom() + kTimelineGap; }
  double axis_bottom() const {
    return p_.class_timeline.empty() ? bottom() : timeline_top() + kTimelineHeight;
  }

  void Ground() {
    for (const PlotBand& band : p_.bands) {
      const double high = std::min(band.to, p_.y_to), low = std::max(band.from, p_.y_from);
      if (band.label.empty() || Y(low) - Y(high) < p_.font_size) continue;
      pen_.Text(p_.left + p_.width + 4, Y((low + high) / 2) + 0.35 * p_.font_size, band.label,
                p_.font_size, kFaint);
    }
    pen_.Clip(p_.left, p_.top, p_.width, p_.height);
    for (const PlotBand& band : p_.bands) {
      const double top = Y(std::min(band.to, p_.y_to)), low = Y(std::max(band.from, p_.y_from));
      if (low > top) pen_.Box(p_.left, top, p_.width, low - top, band.color);
    }
    if (p_.bands.empty()) {
      for (const double y : YTicks()) {
        pen_.Line(p_.left, Y(y), p_.left + p_.width, Y(y), kGrid, 0.5);
      }
    }
    for (const PlotGap& gap : p_.gaps) {
      pen_.Hatch(X(gap.from), p_.top, std::max(0.5, X(gap.to) - X(gap.from)), p_.height);
    }
    pen_.Unclip();
  }

  void Limits() {
    for (const PlotLimit& limit : p_.limits) {
      if (limit.y <= p_.y_from || limit.y >= p_.y_to) continue;
      const double y = Y(limit.y);
      pen_.Line(p_.left, y, p_.left + p_.width, y, kFaint, 0.6, {3, 2});
      if (!limit.label.empty()) {
        pen_.Text(p_.left + p_.width + 4, y + 0.35 * p_.font_size, limit.label, p_.font_size,
                  kFaint);
      }
    }
  }

  void Curves() {
    pen_.Clip(p_.left, p_.top, p_.width, p_.height);
    for (const PlotCurve& curve : p_.curves) {
      auto points = Thinned(curve.points, p_.x_from, p_.x_to, static_cast<int>(2 * p_.width));
      for (auto& [x, y] : points) {
        constexpr double kFar = 1e4;  // pt; Cairo counts in 24 bits
        x = X(x);
        if (!std::isnan(y)) y = std::clamp(Y(y), -kFar, kFar);
      }
      pen_.Polyline(points, curve.color, curve.width, curve.dash);
    }
    pen_.Unclip();
  }

  void ClassTimeline() {
    constexpr double kWide = 200;  // pt; small panels have no room for it
    if (!p_.class_timeline.empty() && p_.width > kWide) {
      pen_.Text(p_.left - kTick - 2, timeline_top() + kTimelineHeight - 1.5, "class", p_.font_size,
                kInk, Pen::Anchor::kRight);
    }
    for (const PlotClassInterval& interval : p_.class_timeline) {
      const double from = X(interval.from), width = std::max(0.3, X(interval.to) - from);
      if (interval.load_class == LoadClass::kUnknown) {
        pen_.Hatch(from, timeline_top(), width, kTimelineHeight);
        continue;
      }
      const double height = kTimelineHeight * static_cast<double>(interval.load_class) / 3;
      pen_.Box(from, timeline_top() + kTimelineHeight - height, width, height,
               ColorOf(interval.load_class));
    }
  }

  std::vector<double> YTicks() const { return TicksOf(p_.y_from, p_.y_to, p_.height, 16); }

  void Axes() {
    const double size = p_.font_size;
    pen_.Line(p_.left, p_.top, p_.left, bottom(), kInk, 0.7);
    pen_.Line(p_.left, axis_bottom(), p_.left + p_.width, axis_bottom(), kInk, 0.7);
    double widest = 0;
    const std::vector<double> ys = YTicks();
    for (const double y : ys) {
      pen_.Line(p_.left - kTick, Y(y), p_.left, Y(y), kInk, 0.7);
      if (!p_.has_y_numbers || ys.size() < 2) continue;
      const std::string text = TickText(y, ys[1] - ys[0]);
      widest = std::max(widest, pen_.TextWidth(text, size));
      pen_.Text(p_.left - kTick - 2, Y(y) + 0.35 * size, text, size, kInk, Pen::Anchor::kRight);
    }
    const std::vector<double> xs = TicksOf(p_.x_from, p_.x_to, p_.width, 45);
    for (const double x : xs) {
      pen_.Line(X(x), axis_bottom(), X(x), axis_bottom() + kTick, kInk, 0.7);
      if (!p_.has_x_numbers || xs.size() < 2) continue;
      pen_.Text(X(x), axis_bottom() + kTick + size + 1, TickText(x, xs[1] - xs[0]), size, kInk,
                Pen::Anchor::kMiddle);
    }
    if (!p_.title.empty()) {
      pen_.Text(p_.left, p_.top - 0.5 * size, p_.title, size, kInk, Pen::Anchor::kLeft, true);
    }
    if (!p_.x_label.empty()) {
      pen_.Text(p_.left + p_.width / 2, axis_bottom() + kTick + 2.3 * size + 2, p_.x_label, size,
                kInk, Pen::Anchor::kMiddle);
    }
    if (!p_.y_label.empty()) {
      pen_.Text(p_.left - kTick - widest - 0.9 * size, p_.top + p_.height / 2, p_.y_label, size,
                kInk, Pen::Anchor::kMiddle, false, true);
    }
  }

  // Above the axes, at the right.
  void Legend() {
    const double size = p_.font_size;
    double right = p_.left + p_.width;
    const double y = p_.top - 0.5 * size;
    for (auto curve = p_.curves.rbegin(); curve != p_.curves.rend(); ++curve) {
      if (curve->name.empty()) continue;
      pen_.Text(right, y, curve->name, size, kInk, Pen::Anchor::kRight);
      right -= pen_.TextWidth(curve->name, size) + 4;
      pen_.Line(right - 16, y - 0.35 * size, right, y - 0.35 * size, curve->color, curve->width,
                curve->dash);
      right -= 16 + 10;
    }
  }

  // Labels that would overlap are left out; the lines stay.
  void Flags() {
    const double size = 0.85 * p_.font_size;
    double free_from = p_.left;
    for (const PlotFlag& flag : p_.flags) {
      const double from = X(std::clamp(flag.from, p_.x_from, p_.x_to));
      const double to = X(std::clamp(flag.to, p_.x_from, p_.x_to));
      pen_.Line(from, p_.top, from, bottom(), kFlagInk, 0.8, {4, 1.5});
      if (to > from) {
        pen_.Line(to, p_.top, to, bottom(), kFlagInk, 0.8, {4, 1.5});
        pen_.Line(from, p_.top + 0.6, to, p_.top + 0.6, kFlagInk, 1.2);
      }
      const double width = pen_.TextWidth(flag.label, size);
      if (flag.label.empty() || from + 2 < free_from) continue;
      const bool fits = from + 2 + width < p_.left + p_.width;
      pen_.Text(fits ? from + 2 : from - 2, p_.top + size + 1, flag.label, size, kFlagInk,
                fits ? Pen::Anchor::kLeft : Pen::Anchor::kRight);
      free_from = from + 4 + width;
    }
  }

  void Marks() {
    for (const PlotMark& mark : p_.marks) {
      const double x = X(mark.x), y = Y(mark.y);
      pen_.Disc(x, y, 0.27 * p_.font_size, kInk);
      if (mark.label.empty()) continue;
      const double width = pen_.TextWidth(mark.label, p_.font_size);
      const bool fits = x + 5 + width < p_.left + p_.width;
      pen_.Text(fits ? x + 5 : x - 5, std::max(y - 3, p_.top + p_.font_size), mark.label,
                p_.font_size, kInk, fits ? Pen::Anchor::kLeft : Pen::Anchor::kRight);
    }
  }

  const PlotPanel& p_;
  Pen& pen_;
};

void Draw(const Plot& plot, Pen& pen) {
  for (const PlotPanel& panel : plot.panels) PanelDrawing(panel, pen).Draw();
  for (const PlotSwatch& swatch : plot.swatches) {
    if (swatch.is_hatched) {
      pen.Hatch(swatch.x, swatch.y, swatch.width, swatch.height);
    } else {
      pen.Box(swatch.x, swatch.y, swatch.width, swatch.height, swatch.color);
    }
  }
  for (const PlotText& text : plot.texts) {
    pen.Text(text.x, text.y, text.text, text.size, text.color, Pen::Anchor::kLeft, text.is_bold);
  }
}

}  // namespace

std::string DrawSvg(const Plot& plot) {
  const auto pen = Pen::ForSvg(plot.width, plot.height);
  Draw(plot, *pen);
  return pen->TakeSvg();
}

Image DrawImage(const Plot& plot, double px_per_pt) {
  const auto pen = Pen::ForImage(plot.width, plot.height, px_per_pt);
  Draw(plot, *pen);
  return pen->TakeImage();
}

}  // namespace kinescope::render::plot
