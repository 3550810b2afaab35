#include "render/image/resample.h"

#include <cstring>

#include "core/system/check.h"

namespace kinescope::render {
namespace {

// Two channels at a time in the halves of a word: sums of 16 levels need 12 of the 16 bits. Plain
// loops of constant length, which the compiler turns into vectors (CMakeLists.txt asks it to).
constexpr std::uint32_t kEvenChannels = 0x00FF00FF;

template <int kFactor>
void AverageRow(const std::uint8_t* __restrict large, std::size_t large_stride, int width,
                std::uint8_t* __restrict out) {
  constexpr unsigned kShift = kFactor == 2 ? 2 : 4;  // log2 of the number of pixels in a box
  constexpr std::uint32_t kHalf = 0x00010001u << (kShift - 1);
  for (int x = 0; x < width; ++x) {
    std::uint32_t even = kHalf, odd = kHalf;
    for (std::size_t row = 0; row < kFactor; ++row) {
      for (std::size_t column = 0; column < kFactor; ++column) {
        std::uint32_t pixel = 0;
        std::memcpy(&pixel,
                    large + row * large_stride +
                        (static_cast<std::size_t>(x) * kFactor + column) * sizeof pixel,
                    sizeof pixel);
        even += pixel & kEvenChannels;
        odd += (pixel >> 8) & kEvenChannels;
      }
    }
    const std::uint32_t average =
        ((even >> kShift) & kEvenChannels) | (((odd >> kShift) & kEvenChannels) << 8);
    std::memcpy(out + static_cast<std::size_t>(x) * sizeof average, &average, sizeof average);
  }
}

}  // namespace

void AverageInto(const std::uint8_t* large, int width, int height, int factor, Image& target, int x,
                 int y) {
  KINESCOPE_CHECK(x >= 0 && y >= 0 && x + width <= target.width && y + height <= target.height);
  const std::size_t stride = static_cast<std::size_t>(width) * static_cast<std::size_t>(factor) * 4;
  for (int row = 0; row < height; ++row) {
    const std::uint8_t* from =
        large + static_cast<std::size_t>(row) * static_cast<std::size_t>(factor) * stride;
    std::uint8_t* to = target.rgba.data() + 4 * (static_cast<std::size_t>(y + row) *
                                                     static_cast<std::size_t>(target.width) +
                                                 static_cast<std::size_t>(x));
    switch (factor) {
      case 1: std::memcpy(to, from, stride); break;
      case 2: AverageRow<2>(from, stride, width, to); break;
      case 4: AverageRow<4>(from, stride, width, to); break;
      default: KINESCOPE_CHECK(!"factor is 1, 2 or 4");
    }
  }
}

}  // namespace kinescope::render
