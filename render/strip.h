/// The machine-readable strip: sample counter and time code as black and white cells along the
/// bottom edge, which survive a video encoder and a picture half as large. docs/pictures.md has the
/// format. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/image.h"
#include "render/painter.h"

namespace kinescope::render {

struct StripCode {
  std::uint32_t counter = 0;
  std::int64_t time_code_millis = 0;  // its lower 48 bits, signed, are kept
  bool operator==(const StripCode& o) const {
    return counter == o.counter && time_code_millis == o.time_code_millis;
  }
};

/// 8 bits 10110100, 32 bits counter, 48 bits time in two's complement, 24 bits check: the lower
/// ones of the CRC-32 (IEEE 802.3) of the ten bytes before. Most significant first.
inline constexpr int kStripBits = 112;

/// How the strip of a picture of this size lies: `rows` of as many cells each, over its whole
/// width.
struct StripLayout {
  int rows = 1;        // 1, 2, 4 or 8: so many that a cell is wide enough to be read
  int row_height = 8;  // px
  int height() const { return rows * row_height; }
};
StripLayout StripLayoutOf(int width_px, int height_px);

/// Paints over the bottom of a picture of this size.
void PaintStrip(Painter& painter, int width_px, int height_px, const StripCode& code);

/// What the strip of `image` says; nullopt when there is none, or it is damaged. Reads pictures of
/// the size that they were drawn with, and half as large.
std::optional<StripCode> ReadStrip(const Image& image);

}  // namespace kinescope::render
