#include "render/image/compare.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <vector>

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

// What a row of pixels differs by. Loops without a way out, so that the compiler looks at many
// pixels at a time.
class RowDifferences {
 public:
  explicit RowDifferences(int width) : pixels_(static_cast<std::size_t>(width)) {}

  /// Returns the largest difference of a channel.
  int Find(const std::uint8_t* a, const std::uint8_t* b, int tolerance) {
    auto* const beyond = reinterpret_cast<std::uint8_t*>(pixels_.data());
    const auto most = static_cast<std::uint8_t>(std::clamp(tolerance, 0, 255));
    const std::size_t size = 4 * pixels_.size();
    std::uint8_t largest = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint8_t low = a[i] < b[i] ? a[i] : b[i], high = a[i] < b[i] ? b[i] : a[i];
      const auto difference = static_cast<std::uint8_t>(high - low);
      largest = difference > largest ? difference : largest;
      beyond[i] = difference > most ? 1 : 0;
    }
    return largest;
  }

  /// Counts the pixels beyond the tolerance, in row `y`: one at least is.
  void AddTo(Comparison& result, int y) const {
    std::uint32_t count = 0;
    for (const std::uint32_t pixel : pixels_) count += static_cast<std::uint32_t>(pixel != 0);
    const auto is_beyond = [](std::uint32_t pixel) { return pixel != 0; };
    const auto first = std::find_if(pixels_.begin(), pixels_.end(), is_beyond);
    const auto last = std::find_if(pixels_.rbegin(), pixels_.rend(), is_beyond);
    if (result.pixels == 0) result.top = y;
    result.pixels += count;
    result.left = std::min(result.left, static_cast<int>(first - pixels_.begin()));
    result.right = std::max(result.right, static_cast<int>(pixels_.rend() - last) - 1);
    result.bottom = y;
  }

 private:
  std::vector<std::uint32_t> pixels_;  // other than 0: beyond the tolerance, a byte per channel
};

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
  const std::size_t row_bytes = 4 * static_cast<std::size_t>(actual.width);
  RowDifferences differences(actual.width);
  for (int y = 0; y < actual.height; ++y) {
    const std::uint8_t* const a = &expected.rgba[static_cast<std::size_t>(y) * row_bytes];
    const std::uint8_t* const b = &actual.rgba[static_cast<std::size_t>(y) * row_bytes];
    if (std::memcmp(a, b, row_bytes) == 0) continue;
    const int largest = differences.Find(a, b, tolerance);
    result.largest_difference = std::max(result.largest_difference, largest);
    if (largest > tolerance) differences.AddTo(result, y);
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
