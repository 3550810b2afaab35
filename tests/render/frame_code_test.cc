#include "render/frame_code.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "render/canvas.h"
#include "render/image/resample.h"

namespace kinescope::render {
namespace {

Image Grey(int width, int height) {
  return {width, height,
          std::vector<std::uint8_t>(static_cast<std::size_t>(4 * width * height), 128)};
}

Image WithFrameCode(int width, int height, const FrameCode& code) {
  Image image = Grey(width, height);
  Canvas canvas(image);
  PaintFrameCode(canvas, width, height, code);
  return image;
}

TEST(FrameCode, IsReadableInAnySizeAndInHalfTheSize) {
  std::mt19937 random(6);
  for (const auto& [width, height] : {std::pair{160, 160}, {320, 240}, {641, 361}, {1080, 1920}}) {
    for (int i = 0; i < 20; ++i) {
      const FrameCode code{static_cast<std::uint32_t>(random()),
                           static_cast<std::int64_t>(random()) - (1LL << 31)};
      const Image image = WithFrameCode(width, height, code);
      ASSERT_EQ(ReadFrameCode(image), code) << width << " x " << height;
      Image half{width / 2, height / 2, {}};
      half.rgba.resize(static_cast<std::size_t>(4 * half.width * half.height));
      if (width % 2 != 0) continue;
      AverageInto(image.rgba.data(), half.width, half.height, 2, half, 0, 0);
      ASSERT_EQ(ReadFrameCode(half), code) << "half of " << width << " x " << height;
    }
  }
}

TEST(FrameCode, KeepsTheLimitsOfItsRange) {
  for (const FrameCode code :
       {FrameCode{0, 0}, FrameCode{0xFFFFFFFF, (1LL << 47) - 1}, FrameCode{1, -(1LL << 47)}}) {
    EXPECT_EQ(ReadFrameCode(WithFrameCode(640, 360, code)), code);
  }
}

TEST(FrameCode, IsUnreadableIfDamagedOrMissing) {
  const FrameCode code{1234567, 89'012'345};
  for (int bit = 0; bit < kFrameCodeBits; ++bit) {
    Image image = WithFrameCode(1120, 360, code);  // cells of 10 px
    for (int y = 350; y < 360; ++y) {
      for (int x = 10 * bit; x < 10 * bit + 10; ++x) {
        for (int channel = 0; channel < 3; ++channel) {
          auto& level = image.rgba[static_cast<std::size_t>(4 * (y * 1120 + x) + channel)];
          level = static_cast<std::uint8_t>(255 - level);
        }
      }
    }
    EXPECT_FALSE(ReadFrameCode(image)) << "cell " << bit << " is turned over";
  }
  EXPECT_FALSE(ReadFrameCode(Grey(640, 360)));
  EXPECT_FALSE(ReadFrameCode(Image()));
  EXPECT_FALSE(ReadFrameCode(Grey(1, 1)));
}

}  // namespace
}  // namespace kinescope::render
