#include "render/image/compare.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace kinescope::render {
namespace {

bool SameSize(const Image& a, const Image& b) { return a.width == b.width && a.height == b.height; }

int PixelDifference(const std::uint8_t* a, const std::uint8_t* b) {
  int largest = 0;
  for (int channel = 0; channel < 4; ++channel) {
    largest = std::max(largest, std::abs(int{a[channel]} - int{b[channel]}));
  }
  return largest;
}

}  // namespace

Comparison Compare(const Image& expected, const Image& actual, int tolerance) {
  Comparison result;
  if (!SameSize(expected, actual)) {
    result.same_size = false;
    result.pixels = std::int64_t{actual.width} * actual.height;
    result.largest_difference = 255;
    result.right = actual.width - 1;
    result.bottom = actual.height - 1;
    return result;
  }
  result.left = actual.width;
  result.top = actual.height;
  result.right = result.bottom = -1;
  std::size_t at = 0;
  for (int y = 0; y < actual.height; ++y) {
    for (int x = 0; x < actual.width; ++x, at += 4) {
      const int difference = PixelDifference(&expected.rgba[at], &actual.rgba[at]);
      result.largest_difference = std::max(result.largest_difference, difference);
      if (difference <= tolerance) continue;
      ++result.pixels;
      result.left = std::min(result.left, x);
      result.right = std::max(result.right, x);
      result.top = std::min(result.top, y);
      result.bottom = std::max(result.bottom, y);
    }
  }
  if (result.pixels == 0) result.left = result.top = result.right = result.bottom = 0;
  return result;
}

std::string Describe(const Comparison& comparison, const Image& actual) {
  char text[160];
  if (!comparison.same_size) {
    std::snprintf(text, sizeof text, "picture size differs: now %d x %d", actual.width,
                  actual.height);
  } else if (comparison.pixels == 0) {
    std::snprintf(text, sizeof text, "pictures are the same (largest difference %d levels)",
                  comparison.largest_difference);
  } else {
    const double percent = 100.0 * static_cast<double>(comparison.pixels) /
                           (static_cast<double>(actual.width) * actual.height);
    std::snprintf(text, sizeof text,
                  "%lld pixels differ (%.2f %%), in x %d..%d, y %d..%d, by up to %d levels",
                  static_cast<long long>(comparison.pixels), percent, comparison.left,
                  comparison.right, comparison.top, comparison.bottom,
                  comparison.largest_difference);
  }
  return text;
}

Image DiffImage(const Image& expected, const Image& actual, int tolerance) {
  Image diff;
  diff.width = actual.width;
  diff.height = actual.height;
  diff.rgba.resize(actual.rgba.size());
  const bool same_size = SameSize(expected, actual);
  for (std::size_t at = 0; at + 3 < actual.rgba.size(); at += 4) {
    const std::uint8_t* now = &actual.rgba[at];
    const bool differs = !same_size || PixelDifference(&expected.rgba[at], now) > tolerance;
    // Pale, so that red stands out: the darkest grey is 160.
    const int grey = 160 + (now[0] * 54 + now[1] * 183 + now[2] * 19) / 256 * 95 / 255;
    diff.rgba[at] = static_cast<std::uint8_t>(differs ? 220 : grey);
    diff.rgba[at + 1] = diff.rgba[at + 2] = static_cast<std::uint8_t>(differs ? 0 : grey);
    diff.rgba[at + 3] = 255;
  }
  return diff;
}

}  // namespace kinescope::render
