#include "render/overlay_scale.h"

#include <cmath>
#include <cstdio>

namespace kinescope::render {
namespace {

constexpr double kLongest = 0.16;  // of the picture's width

std::string LengthText(double metres) {
  const auto text = [](double value, const char* unit) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%.0f %s", value, unit);
    return std::string(buffer);
  };
  if (metres >= 999.5) return text(metres / 1000, "km");
  if (metres >= 0.995) return text(metres, "m");
  return metres >= 0.00995 ? text(metres * 100, "cm") : text(metres * 1000, "mm");
}

}  // namespace

ScaleBar ScaleBarOf(const Camera& camera, int width_px, int height_px, double most_px) {
  const Projected target = Project(camera.target, camera, width_px, height_px);
  ScaleBar bar;
  if (!(target.depth_m > 0 && target.px_per_m > 0)) return bar;
  const double most_m = most_px / target.px_per_m;
  const double power = std::pow(10, std::floor(std::log10(most_m)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power <= most_m * (1 + 1e-9)) bar.length_m = factor * power;
  }
  bar.length_px = bar.length_m * target.px_per_m;
  bar.text = LengthText(bar.length_m);
  return bar;
}

void PaintScaleBar(OverlayPage& page, const Camera& camera, double above_bottom) {
  const ScaleBar bar = ScaleBarOf(camera, static_cast<int>(page.width),
                                  static_cast<int>(page.height), kLongest * page.width);
  if (bar.length_px < 1) return;
  const int size = page.FontPx(kSmallSize);
  const double right = page.right(), left = right - bar.length_px;
  const double y = page.bottom - above_bottom - 1.35 * size;
  const double tick = std::max(3.0, page.Px(5)), width = std::max(1.0, page.Px(1.6));
  // The ends of the line, not the ends of its round caps, are the length.
  const auto line = [&](double thickness, const Ink& ink) {
    page.canvas.Polyline({{left, y - tick}, {left, y}, {right, y}, {right, y - tick}}, thickness,
                         ink);
  };
  line(3 * width, page.inks.halo);
  line(width, page.inks.line);
  const double text_width = page.fonts.regular.Width(bar.text, size);
  const double middle = std::min((left + right) / 2, right - text_width / 2);
  page.canvas.Text(middle - text_width / 2, y + 1.35 * size, bar.text, page.fonts.regular, size,
                   page.inks.text);
}

}  // namespace kinescope::render
