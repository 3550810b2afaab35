/// Compares two pictures for golden checks: how many pixels differ, where, and a picture of the
/// differences. Pure functions, any thread.
#pragma once

#include <cstdint>
#include <string>

#include "render/image/image.h"

namespace kinescope::render {

/// Differences in rounding between compilers, drivers and processors do not exceed this many
/// levels.
inline constexpr int kChannelTolerance = 2;

struct Comparison {
  bool same_size = true;       // if false, every pixel counts as different
  std::int64_t pixels = 0;     // that differ by more than the tolerance in any channel
  int largest_difference = 0;  // levels, of any channel, including differences within the tolerance
  int left = 0, top = 0, right = 0, bottom = 0;  // px, box of the differing pixels, inclusive
  bool equal() const { return same_size && pixels == 0; }
};

Comparison Compare(const Image& expected, const Image& actual, int tolerance = kChannelTolerance);

/// One line for messages: "123 pixels differ (0.01 %), in x 10..40, y 5..9, by up to 77 levels".
std::string Describe(const Comparison& comparison, const Image& actual);

/// `actual` in pale grey with the differing pixels in red; completely red if the sizes differ.
Image DiffImage(const Image& expected, const Image& actual, int tolerance = kChannelTolerance);

}  // namespace kinescope::render
