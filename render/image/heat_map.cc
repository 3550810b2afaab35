#include "render/image/heat_map.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "render/image/luma.h"

namespace kinescope::render {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr Color kOutside = {214, 40, 40};

Color ColorOf(PixelMark mark) {
  switch (mark) {
    case PixelMark::kEdge: return {60, 120, 230};
    case PixelMark::kSlight: return {250, 195, 40};
    case PixelMark::kClear: return {240, 120, 20};
    case PixelMark::kStrong: return {205, 30, 30};
    case PixelMark::kTotal:
    case PixelMark::kSame: break;
  }
  return {95, 0, 70};
}

// On white, and so pale that the colours stand out: the darkest grey is 160.
Color Pale(const std::uint8_t* pixel) {
  const int luma = LumaOf(pixel[0], pixel[1], pixel[2]);
  const int on_white = 255 - (255 - luma) * pixel[3] / 255;
  const auto grey = static_cast<std::uint8_t>(160 + on_white * 95 / 255);
  return {grey, grey, grey};
}

}  // namespace

Image HeatMap(const Image& expected, const PictureDifference& difference) {
  const int common_width = std::min(difference.expected_width, difference.actual_width);
  const int common_height = std::min(difference.expected_height, difference.actual_height);
  Image map;
  SetSize(map, std::max(difference.expected_width, difference.actual_width),
          std::max(difference.expected_height, difference.actual_height));
  std::uint8_t* out = map.rgba.data();
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x, out += 4) {
      const std::size_t at = static_cast<std::size_t>(y) * expected.width + x;
      const bool is_common = x < common_width && y < common_height;
      const PixelMark mark = is_common && !difference.pixels.marks.empty()
                                 ? difference.pixels.marks[at]
                                 : PixelMark::kSame;
      const Color color = !is_common                 ? kOutside
                          : mark == PixelMark::kSame ? Pale(&expected.rgba[4 * at])
                                                     : ColorOf(mark);
      std::copy(color.begin(), color.end(), out);
      out[3] = 255;
    }
  }
  map.is_opaque = true;
  return map;
}

}  // namespace kinescope::render
