#include "render/overlay_plot.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "core/palette.h"
#include "render/plot.h"

namespace kinescope::render {
namespace {

// Of a picture 720 px high.
constexpr double kWidth = 300, kNarrowest = 0.30;  // the latter: of the picture's width, at most
constexpr double kHead = 17, kAxes = 46, kGap = 9, kPad = 10, kFoot = 16;

struct Frame {
  double left, top, width, height;
  double from_secs, to_secs, top_ratio;
  std::array<double, 2> class_limits;
  double X(double secs) const { return left + width * (secs - from_secs) / (to_secs - from_secs); }
  double Y(double ratio) const {
    return top + height * (1 - std::clamp(ratio / top_ratio, 0.0, 1.0));
  }
};

// The same for all rows, so that they compare: all of capacity and some of the high class, or more
// where more was needed.
double TopRatio(const LoadCurves& loads, const std::array<double, 2>& class_limits) {
  const auto round_up = [](double ratio) { return std::ceil(2 * ratio - 1e-9) / 2; };
  const double least = round_up(std::max(1.0, 1.1 * class_limits[1]));
  double top = least;
  for (const LoadCurve& curve : loads.curves) {
    for (const LoadPoint& point : curve.points) {
      if (std::isfinite(point.ratio)) top = std::max(top, point.ratio);
    }
  }
  return std::min(round_up(top), std::max(least, 3.0));
}

const LoadPoint* PointAt(const LoadCurve& curve, double secs) {
  const auto next =
      std::upper_bound(curve.points.begin(), curve.points.end(), secs + 1e-6,
                       [](double at, const LoadPoint& point) { return at < point.secs; });
  return next == curve.points.begin() ? nullptr : &*std::prev(next);
}

void PaintBands(OverlayPage& page, const Frame& frame) {
  const auto band = [&](LoadClass load_class, double from, double to) {
    const double top = std::round(frame.Y(to)), bottom = std::round(frame.Y(from));
    page.canvas.RoundedBox(frame.left, top, frame.width, bottom - top, 0,
                           {ColorOf(load_class), page.inks.band_alpha});
  };
  const auto [medium_from, high_from] = frame.class_limits;
  band(LoadClass::kLow, 0, medium_from);
  band(LoadClass::kMedium, medium_from, high_from);
  band(LoadClass::kHigh, high_from, frame.top_ratio);
}

void PaintCurve(OverlayPage& page, const Frame& frame, const LoadCurve& curve) {
  std::vector<std::pair<double, double>> points;
  for (const LoadPoint& point : curve.points) {
    if (point.secs >= frame.from_secs && point.secs <= frame.to_secs) {
      points.emplace_back(point.secs, point.ratio);
    }
  }
  points =
      Thinned(points, frame.from_secs, frame.to_secs, std::max(1, static_cast<int>(frame.width)));
  const double width = std::max(1.0, page.Px(1.5));
  std::vector<std::pair<double, double>> piece;
  const auto flush = [&] {
    page.canvas.Polyline(piece, width, page.inks.line);
    piece.clear();
  };
  for (const auto& [secs, ratio] : points) {
    if (std::isfinite(ratio)) {
      piece.emplace_back(frame.X(secs), frame.Y(ratio));
    } else {
      flush();
    }
  }
  flush();
}

std::string SecsText(double secs) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(secs) < 100 ? "%.1f s" : "%.0f s", secs);
  return text;
}

// has_scale: tells what the upper edge stands for.
void PaintRow(OverlayPage& page, const Frame& frame, const LoadCurve& curve, double now_secs,
              bool has_scale) {
  const int size = page.FontPx(kSmallSize);
  const LoadPoint* now = PointAt(curve, now_secs);
  char value[32] = "unknown";
  if (now != nullptr && std::isfinite(now->ratio)) {
    std::snprintf(value, sizeof value, "%.0f %%", 100 * now->ratio);
  }
  const double baseline = frame.top - 0.35 * size;
  const double value_width = page.fonts.bold.Width(value, size);
  const std::string name =
      Shorten(curve.name, page.fonts.regular, size, frame.width - value_width - 1.8 * size);
  page.canvas.Text(frame.left, baseline, name, page.fonts.regular, size, page.inks.text);
  const double value_left = frame.left + frame.width - value_width;
  page.canvas.Text(value_left, baseline, value, page.fonts.bold, size, page.inks.text);
  const LoadClass load_class = now != nullptr ? now->load_class : LoadClass::kUnknown;
  page.canvas.Disc(value_left - 0.7 * size, baseline - 0.36 * size, 0.36 * size,
                   {ColorOf(load_class), 1});

  PaintBands(page, frame);
  const int small = page.AxisFontPx();
  if (has_scale && frame.height >= 3 * small) {  // lower ones have no room for a text and a curve
    char text[32];
    std::snprintf(text, sizeof text, "%.0f %%", 100 * frame.top_ratio);
    page.canvas.Text(frame.left + 0.3 * small, frame.top + small, text, page.fonts.regular, small,
                     page.inks.faint_text);
  }
  PaintCurve(page, frame, curve);
  const double x = std::clamp(frame.X(now_secs), frame.left, frame.left + frame.width);
  const double thin = std::max(1.0, page.Px(1));
  page.canvas.RoundedBox(std::round(x - thin / 2), frame.top, std::round(thin), frame.height, 0,
                         page.inks.faint_text);
  if (now != nullptr && std::isfinite(now->ratio)) {
    const double radius = std::max(2.0, page.Px(3.6));
    page.canvas.Disc(x, frame.Y(now->ratio), 1.45 * radius, page.inks.line);
    page.canvas.Disc(x, frame.Y(now->ratio), radius, {ColorOf(load_class), 1});
  }
}

// px; text has a least size, so rows follow it and not the picture alone.
struct RowSizes {
  double head, foot, pad, row;

  double PanelHeight(std::size_t rows, double gap) const {
    return 2 * pad + static_cast<double>(rows) * row - gap + foot;
  }
};
RowSizes RowSizesOf(const OverlaySizes& page) {
  const int size = page.FontPx(kSmallSize);
  const double head = std::max(page.Px(kHead), 1.3 * size);
  return {head, std::max(page.Px(kFoot), 1.2 * size), page.Px(kPad),
          head + page.Px(kAxes) + page.Px(kGap)};
}

double PanelWidth(const OverlaySizes& page) {
  const int size = page.FontPx(kSmallSize);
  return std::max(std::min(page.Px(kWidth), kNarrowest * page.width),
                  std::min(12.0 * size, 0.5 * page.width));
}

}  // namespace

PlotRoom RoomOfPlot(const OverlaySizes& sizes, std::size_t rows) {
  const double top = sizes.Px(kMargin) + 1.8 * sizes.FontPx(kTextSize);
  return {top, PanelWidth(sizes), RowSizesOf(sizes).PanelHeight(rows, sizes.Px(kGap))};
}

void PaintPlot(OverlayPage& page, const LoadCurves& loads,
               const std::array<double, 2>& class_limits, double now_secs, double top,
               double bottom) {
  if (loads.curves.empty()) return;
  const int size = page.FontPx(kSmallSize);
  const RowSizes sizes = RowSizesOf(page);
  const auto [head, foot, pad, row] = sizes;
  const double room = bottom - top - 2 * pad - foot + page.Px(kGap);
  const auto rows = std::min(loads.curves.size(),
                             static_cast<std::size_t>(std::max(0.0, std::floor(room / row))));
  if (rows == 0) return;
  const std::size_t hidden = loads.curves.size() - rows;
  const double width = PanelWidth(page);
  const double left = std::round(page.right() - width);
  const double panel_height = sizes.PanelHeight(rows, page.Px(kGap));
  page.canvas.RoundedBox(left, top, width, panel_height, page.Px(8), page.inks.panel);
  Frame frame{std::round(left + pad),
              0,
              std::round(width - 2 * pad),
              std::round(page.Px(kAxes)),
              loads.from_secs,
              loads.to_secs,
              TopRatio(loads, class_limits),
              class_limits};
  for (std::size_t i = 0; i < rows; ++i) {
    frame.top = std::round(top + pad + static_cast<double>(i) * row + head);
    PaintRow(page, frame, loads.curves[i], now_secs, i == 0);
  }
  const double baseline = frame.top + frame.height + 0.95 * size;
  const int small = page.AxisFontPx();
  const std::string from = SecsText(loads.from_secs), to = SecsText(loads.to_secs);
  page.canvas.Text(frame.left, baseline, from, page.fonts.regular, small, page.inks.faint_text);
  const double to_left = frame.left + frame.width - page.fonts.regular.Width(to, small);
  page.canvas.Text(to_left, baseline, to, page.fonts.regular, small, page.inks.faint_text);
  if (hidden == 0) return;
  const double from_right = frame.left + page.fonts.regular.Width(from, small);
  for (const std::string& more :
       {"+ " + std::to_string(hidden) + " more", "+" + std::to_string(hidden)}) {
    const double more_width = page.fonts.regular.Width(more, small);
    const double more_left = (from_right + to_left - more_width) / 2;
    if (more_left < from_right + 0.4 * small) continue;
    page.canvas.Text(more_left, baseline, more, page.fonts.regular, small, page.inks.faint_text);
    return;
  }
}

}  // namespace kinescope::render
