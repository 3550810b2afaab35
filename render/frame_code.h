/// Paints and reads the machine-readable frame code: sample counter and time code as black and
/// white cells along the bottom edge. It survives a video encoder and scaling to half the size.
/// docs/pictures.md describes the format. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "render/image/image.h"
#include "render/painter.h"

namespace kinescope::render {

struct FrameCode {
  std::uint32_t counter = 0;
  std::int64_t time_code_millis = 0;  // only the lower 48 bits, signed, are stored
  bool operator==(const FrameCode& o) const {
    return counter == o.counter && time_code_millis == o.time_code_millis;
  }
};

/// 8 bits 10110100, 32 bits counter, 48 bits time in two's complement, 24 bits check: the lower
/// ones of the CRC-32 (IEEE 802.3) of the ten bytes before. Most significant first.
inline constexpr int kFrameCodeBits = 112;

/// Layout of the frame code in a picture of this size: `rows` with equal numbers of cells over the
/// whole width.
struct FrameCodeLayout {
  int rows = 1;        // 1, 2, 4 or 8: as many as needed for readable cells
  int row_height = 8;  // px
  int height() const { return rows * row_height; }
};
FrameCodeLayout FrameCodeLayoutOf(int width_px, int height_px);

/// Paints it over the bottom of a picture of this size.
void PaintFrameCode(Painter& painter, int width_px, int height_px, const FrameCode& code);

/// Reads the frame code of `image`; nullopt if there is none, or if it is damaged. Reads pictures
/// at their original size and at half of it.
std::optional<FrameCode> ReadFrameCode(const Image& image);

}  // namespace kinescope::render
