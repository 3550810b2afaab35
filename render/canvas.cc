#include "render/canvas.h"

#include <algorithm>
#include <cmath>

namespace kinescope::render {
namespace {

// Share of a pixel that lies inside an edge whose signed distance (inside positive) is `distance`.
double EdgeCoverage(double distance) { return std::clamp(distance + 0.5, 0.0, 1.0); }

}  // namespace

// An ink in the units of a pixel.
struct Canvas::Paint {
  explicit Paint(const Ink& ink) : alpha(256 * ink.alpha) {
    for (std::size_t channel = 0; channel < 3; ++channel) {
      levels[channel] = static_cast<int>(std::lround(255 * ink.color[channel]));
    }
  }
  int levels[3];
  double alpha;
};

void Canvas::Blend(int x, int y, const Paint& paint, double coverage) {
  const int weight = static_cast<int>(paint.alpha * coverage + 0.5);
  if (weight == 0) return;
  std::uint8_t* pixel =
      &image_.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                        static_cast<std::size_t>(x))];
  for (std::size_t channel = 0; channel < 3; ++channel) {
    pixel[channel] = static_cast<std::uint8_t>(
        (pixel[channel] * (256 - weight) + paint.levels[channel] * weight + 128) / 256);
  }
}

template <class Coverage>
void Canvas::Fill(double left, double top, double right, double bottom, const Ink& ink,
                  Coverage&& coverage) {
  const Paint paint(ink);
  const int first_x = std::max(0, static_cast<int>(std::floor(left - 1)));
  const int last_x = std::min(image_.width - 1, static_cast<int>(std::ceil(right + 1)));
  const int first_y = std::max(0, static_cast<int>(std::floor(top - 1)));
  const int last_y = std::min(image_.height - 1, static_cast<int>(std::ceil(bottom + 1)));
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) Blend(x, y, paint, coverage(x + 0.5, y + 0.5));
  }
}

void Canvas::RoundedBox(double x, double y, double width, double height, double radius,
                        const Ink& ink) {
  const double center_x = x + width / 2, center_y = y + height / 2;
  Fill(x, y, x + width, y + height, ink, [&](double px, double py) {
    const double out_x = std::abs(px - center_x) - (width / 2 - radius);
    const double out_y = std::abs(py - center_y) - (height / 2 - radius);
    // Most pixels are clear of the corners, and need no root.
    const bool is_corner = out_x > 0 && out_y > 0;
    const double distance =
        is_corner ? std::sqrt(out_x * out_x + out_y * out_y) : std::max(out_x, out_y);
    return EdgeCoverage(radius - distance);
  });
}

void Canvas::Disc(double x, double y, double radius, const Ink& ink) {
  Fill(x - radius, y - radius, x + radius, y + radius, ink,
       [&](double px, double py) { return EdgeCoverage(radius - std::hypot(px - x, py - y)); });
}

void Canvas::Ring(double x, double y, double inner_radius, double outer_radius, const Ink& ink) {
  Fill(x - outer_radius, y - outer_radius, x + outer_radius, y + outer_radius, ink,
       [&](double px, double py) {
         const double distance = std::hypot(px - x, py - y);
         return std::min(EdgeCoverage(outer_radius - distance),
                         EdgeCoverage(distance - inner_radius));
       });
}

double Canvas::Text(double x, double y, std::string_view utf8, Font& font, int size_px,
                    const Ink& ink) {
  const Paint paint(ink);
  const int baseline = static_cast<int>(std::lround(y));
  for (const char32_t code_point : DecodeUtf8(utf8)) {
    const Glyph& glyph = font.Get(code_point, size_px);
    const int left = static_cast<int>(std::lround(x)) + glyph.left;
    const int top = baseline - glyph.top;
    for (int row = std::max(0, -top); row < std::min(glyph.height, image_.height - top); ++row) {
      for (int column = std::max(0, -left); column < std::min(glyph.width, image_.width - left);
           ++column) {
        const auto at = static_cast<std::size_t>(row * glyph.width + column);
        if (glyph.coverage[at] != 0)
          Blend(left + column, top + row, paint, glyph.coverage[at] / 255.0);
      }
    }
    x += glyph.advance;
  }
  return x;
}

}  // namespace kinescope::render
