#include "render/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/system/utf8.h"

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

void Canvas::Mark(int x, int y, int width, int height) {
  MarkChanged(image_, {part_.x + x, part_.y + y, width, height});
}

void Canvas::Blend(int x, int y, const Paint& paint, double coverage) {
  BlendRow(x, x, y, paint, coverage);
}

void Canvas::BlendRow(int first_x, int last_x, int y, const Paint& paint, double coverage) {
  const auto weight = static_cast<std::uint16_t>(std::lround(paint.alpha * coverage));
  if (weight == 0) return;
  // What stays of each channel, in 256ths, and what is added. Alpha stays. All of it fits into 16
  // bits, so that the compiler does several pixels at once.
  constexpr std::uint16_t kOne = 256, kHalf = 128;
  std::array<std::uint16_t, 4> keep = {}, add = {};
  for (std::size_t channel = 0; channel < 4; ++channel) {
    const bool is_color = channel < 3;
    keep[channel] = static_cast<std::uint16_t>(is_color ? kOne - weight : kOne);
    add[channel] =
        static_cast<std::uint16_t>(is_color ? paint.levels[channel] * weight + kHalf : kHalf);
  }
  std::uint8_t* pixel = &image_.rgba[4 * (static_cast<std::size_t>(part_.y + y) *
                                              static_cast<std::size_t>(image_.width) +
                                          static_cast<std::size_t>(part_.x + first_x))];
  for (int x = first_x; x <= last_x; ++x, pixel += 4) {
    for (std::size_t channel = 0; channel < 4; ++channel) {
      const auto sum = static_cast<std::uint16_t>(pixel[channel] * keep[channel] + add[channel]);
      pixel[channel] = static_cast<std::uint8_t>(sum / kOne);
    }
  }
}

template <class Coverage>
void Canvas::Fill(double left, double top, double right, double bottom, const Ink& ink,
                  Coverage&& coverage, const std::function<Columns(double y)>& whole) {
  const Paint paint(ink);
  const int first_x = std::max(0, static_cast<int>(std::floor(left - 1)));
  const int last_x = std::min(part_.width - 1, static_cast<int>(std::ceil(right + 1)));
  const int first_y = std::max(0, static_cast<int>(std::floor(top - 1)));
  const int last_y = std::min(part_.height - 1, static_cast<int>(std::ceil(bottom + 1)));
  Mark(first_x, first_y, last_x - first_x + 1, last_y - first_y + 1);
  for (int y = first_y; y <= last_y; ++y) {
    const auto blend = [&](int from, int to) {
      for (int x = from; x <= to; ++x) Blend(x, y, paint, coverage(x + 0.5, y + 0.5));
    };
    const Columns inside = whole ? whole(y + 0.5) : Columns();
    const int first_whole = std::max(first_x, static_cast<int>(std::ceil(inside.first)));
    const int last_whole = std::min(last_x, static_cast<int>(std::floor(inside.last)) - 1);
    if (first_whole > last_whole) {
      blend(first_x, last_x);
      continue;
    }
    blend(first_x, first_whole - 1);
    BlendRow(first_whole, last_whole, y, paint, 1);
    blend(last_whole + 1, last_x);
  }
}

void Canvas::RoundedBox(double x, double y, double width, double height, double radius,
                        const Ink& ink) {
  const double center_x = x + width / 2, center_y = y + height / 2;
  const auto coverage = [&](double px, double py) {
    const double out_x = std::abs(px - center_x) - (width / 2 - radius);
    const double out_y = std::abs(py - center_y) - (height / 2 - radius);
    // Most pixels are clear of the corners, and need no root.
    const bool is_corner = out_x > 0 && out_y > 0;
    const double distance =
        is_corner ? std::sqrt(out_x * out_x + out_y * out_y) : std::max(out_x, out_y);
    return EdgeCoverage(radius - distance);
  };
  // Most are not even near the edge.
  const double corner = std::max(radius, 1.0);
  const auto whole = [&](double py) -> Columns {
    const bool is_inside = std::abs(py - center_y) < height / 2 - 1;
    return is_inside ? Columns{x + corner, x + width - corner} : Columns();
  };
  Fill(x, y, x + width, y + height, ink, coverage, whole);
}

void Canvas::Picture(int x, int y, const Image& pixels) {
  const int first_x = std::max(0, x), last_x = std::min(part_.width, x + pixels.width);
  const int first_y = std::max(0, y), last_y = std::min(part_.height, y + pixels.height);
  if (first_x >= last_x || first_y >= last_y) return;
  Mark(first_x, first_y, last_x - first_x, last_y - first_y);
  const auto at = [](const Image& image, int column, int row) {
    return 4 * (static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
                static_cast<std::size_t>(column));
  };
  const auto row_bytes = 4 * static_cast<std::ptrdiff_t>(last_x - first_x);
  for (int row = first_y; row < last_y; ++row) {
    const auto from =
        pixels.rgba.begin() + static_cast<std::ptrdiff_t>(at(pixels, first_x - x, row - y));
    std::copy(from, from + row_bytes,
              image_.rgba.begin() +
                  static_cast<std::ptrdiff_t>(at(image_, part_.x + first_x, part_.y + row)));
  }
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

// By the nearest piece of the whole line, so that where pieces meet nothing is painted twice.
void Canvas::Polyline(const std::vector<std::pair<double, double>>& points, double width,
                      const Ink& ink) {
  if (points.empty()) return;
  double left = points[0].first, right = left, top = points[0].second, bottom = top;
  for (const auto& [x, y] : points) {
    left = std::min(left, x), right = std::max(right, x);
    top = std::min(top, y), bottom = std::max(bottom, y);
  }
  const double reach = width / 2 + 1;
  const int first_x = std::max(0, static_cast<int>(std::floor(left - reach)));
  const int last_x = std::min(part_.width - 1, static_cast<int>(std::ceil(right + reach)));
  const int first_y = std::max(0, static_cast<int>(std::floor(top - reach)));
  const int last_y = std::min(part_.height - 1, static_cast<int>(std::ceil(bottom + reach)));
  if (first_x > last_x || first_y > last_y) return;
  const auto columns = static_cast<std::size_t>(last_x) - static_cast<std::size_t>(first_x) + 1;
  const auto rows = static_cast<std::size_t>(last_y) - static_cast<std::size_t>(first_y) + 1;
  std::vector<double> coverage(columns * rows, 0.0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto [x0, y0] = points[i];
    const auto [x1, y1] = points[std::min(i + 1, points.size() - 1)];
    const double dx = x1 - x0, dy = y1 - y0, length2 = dx * dx + dy * dy;
    const auto begin = [&](double at, int first) {
      return std::max(first, static_cast<int>(std::floor(at - reach)));
    };
    const auto end = [&](double at, int last) {
      return std::min(last, static_cast<int>(std::ceil(at + reach)));
    };
    for (int y = begin(std::min(y0, y1), first_y); y <= end(std::max(y0, y1), last_y); ++y) {
      for (int x = begin(std::min(x0, x1), first_x); x <= end(std::max(x0, x1), last_x); ++x) {
        const double px = x + 0.5 - x0, py = y + 0.5 - y0;
        const double t = length2 > 0 ? std::clamp((px * dx + py * dy) / length2, 0.0, 1.0) : 0;
        const double ox = px - t * dx, oy = py - t * dy;
        double& mine = coverage[static_cast<std::size_t>(y - first_y) * columns +
                                static_cast<std::size_t>(x - first_x)];
        mine = std::max(mine, EdgeCoverage(width / 2 - std::sqrt(ox * ox + oy * oy)));
      }
    }
  }
  const Paint paint(ink);
  for (int y = first_y; y <= last_y; ++y) {
    for (int x = first_x; x <= last_x; ++x) {
      const double covered = coverage[static_cast<std::size_t>(y - first_y) * columns +
                                      static_cast<std::size_t>(x - first_x)];
      if (covered == 0) continue;  // most of the box around a slanted line
      Mark(x, y, 1, 1);
      Blend(x, y, paint, covered);
    }
  }
}

double Canvas::Text(double x, double y, std::string_view utf8, Font& font, int size_px,
                    const Ink& ink) {
  const Paint paint(ink);
  const int baseline = static_cast<int>(std::lround(y));
  for (const char32_t code_point : DecodeUtf8(utf8)) {
    const Glyph& glyph = font.Get(code_point, size_px);
    const int left = static_cast<int>(std::lround(x)) + glyph.left;
    const int top = baseline - glyph.top;
    Mark(left, top, glyph.width, glyph.height);
    for (int row = std::max(0, -top); row < std::min(glyph.height, part_.height - top); ++row) {
      for (int column = std::max(0, -left); column < std::min(glyph.width, part_.width - left);
           ++column) {
        const auto at = static_cast<std::size_t>(row) * static_cast<std::size_t>(glyph.width) +
                        static_cast<std::size_t>(column);
        if (glyph.coverage[at] != 0)
          Blend(left + column, top + row, paint, glyph.coverage[at] / 255.0);
      }
    }
    x += glyph.advance;
  }
  return x;
}

}  // namespace kinescope::render
