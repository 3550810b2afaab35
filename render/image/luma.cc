#include "render/image/luma.h"

#include <algorithm>
#include <cstring>

namespace kinescope::render {
namespace {

std::size_t WithMargin(int side) {
  const int cells = std::max(2, (side + LumaPlane::kCell - 1) / LumaPlane::kCell);
  return static_cast<std::size_t>(cells) * LumaPlane::kCell;
}

}  // namespace

LumaPlane::LumaPlane(const Image& image)
    : width(image.width),
      height(image.height),
      stride(WithMargin(image.width)),
      levels(stride * WithMargin(image.height)) {
  for (int y = 0; y < height; ++y) TakeRow(image, y, 0, width);
  FillMargin();
}

void LumaPlane::TakeRow(const Image& image, int y, int from, int to) {
  const std::uint8_t* const pixel = &image.rgba[4 * (static_cast<std::size_t>(y) * width + from)];
  std::uint8_t* const out = Row(y) + from;
  for (int i = 0; i < to - from; ++i) {
    out[i] = LumaOf(pixel[4 * i], pixel[4 * i + 1], pixel[4 * i + 2]);
  }
}

void LumaPlane::FillMargin() {
  for (int y = 0; y < height; ++y) {
    std::uint8_t* const row = Row(y);
    std::memset(row + width, row[width - 1], stride - static_cast<std::size_t>(width));
  }
  const auto all_rows = static_cast<int>(levels.size() / stride);
  for (int y = height; y < all_rows; ++y) std::memcpy(Row(y), Row(height - 1), stride);
}

}  // namespace kinescope::render
