/// Converts pictures to the planes that video encoders take: YUV 4:2:0, BT.709, limited range (16
/// to 235 and 16 to 240). Pure functions, any thread. In integers, so that every compiler and
/// processor gives the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "render/image/image.h"

namespace kinescope::render {

/// Planes of one picture, top row first; borrowed. Of `u` and `v`, one value is for two by two
/// pixels.
struct YuvPlanes {
  std::uint8_t* y = nullptr;
  std::uint8_t* u = nullptr;
  std::uint8_t* v = nullptr;
  std::ptrdiff_t y_stride = 0, u_stride = 0, v_stride = 0;  // bytes from row to row
};

/// Writes the pixels of `image` in the box at column `x`, row `y` to the same place in `planes`,
/// which are of the size of `image`. Alpha is ignored. `u` and `v` are made of the mean of two by
/// two pixels and of no pixel beside them, so a picture that is converted in parts is the same as
/// one that is converted at once.
/// @pre the four numbers are even, and the box is inside `image`
void ToYuv(const Image& image, int x, int y, int width, int height, const YuvPlanes& planes);

/// Copies the alpha of `image` to `plane`, which has its size.
void CopyAlpha(const Image& image, std::uint8_t* plane, std::ptrdiff_t stride);

}  // namespace kinescope::render
