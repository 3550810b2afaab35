#include "server/ros/point_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "server/ros/shown_parts.h"

namespace kinescope::ros_bridge {
namespace {

Rgb Between(const Rgb& a, const Rgb& b, double share) {
  Rgb mixed;
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = (1 - share) * a[i] + share * b[i];
  return mixed;
}

// Saturated hues through six stops: red at 0, magenta at 1.
Rgb Rainbow(double share) {
  static constexpr std::array<Rgb, 6> kStops = {
      {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}}};
  const double at = 5 * share;
  const std::size_t first = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  return Between(kStops[first], kStops[first + 1], at - static_cast<double>(first));
}

struct Bounds {
  double from = std::numeric_limits<double>::infinity(), to = -from;
};

Bounds BoundsOf(const std::vector<double>& values, const PointScale& scale) {
  Bounds bounds;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    bounds.from = std::min(bounds.from, value);
    bounds.to = std::max(bounds.to, value);
  }
  return {scale.from.value_or(bounds.from), scale.to.value_or(bounds.to)};
}

Rgb ColorAt(double share, const PointScale& scale) {
  if (!scale.low && !scale.high) return Rainbow(scale.is_inverted ? 1 - share : share);
  return Between(scale.low.value_or(Rgb{0, 0, 0}), scale.high.value_or(Rgb{1, 1, 1}), share);
}

}  // namespace

std::optional<int> AxisOf(const ShownStyle& style) {
  if (!style.scale || style.color) return std::nullopt;
  for (const int axis : {0, 1, 2}) {
    if (style.scale->by == std::string(1, "xyz"[axis])) return axis;
  }
  return std::nullopt;
}

std::optional<int> SceneAxisOf(const ShownStyle& style) {
  return style.scale && style.scale->is_in_message ? std::nullopt : AxisOf(style);
}

std::vector<std_msgs::ColorRGBA> ColorsOf(const std::vector<double>& values,
                                          const ShownStyle& style) {
  const PointScale scale = style.scale.value_or(PointScale{});
  const Bounds bounds = BoundsOf(values, scale);
  // Of equal bounds RViz makes 1 mm for an axis, and something huge for an intensity.
  constexpr double kNarrow = 0.001, kHuge = 1e20;
  const double extent = bounds.to - bounds.from;
  const double range = extent != 0 ? extent : AxisOf(style) ? kNarrow : kHuge;
  ShownStyle of_value;
  of_value.alpha = style.alpha;
  std::vector<std_msgs::ColorRGBA> colors;
  colors.reserve(values.size());
  for (const double value : values) {
    const double share =
        std::isfinite(value) ? std::clamp((value - bounds.from) / range, 0.0, 1.0) : 0;
    of_value.color = ColorAt(share, scale);
    colors.push_back(In(of_value, Color(0, 0, 0)));
  }
  return colors;
}

}  // namespace kinescope::ros_bridge
