// Alpha out of a picture over white and the same over black.
#include "render/image/matte.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>

namespace kinescope::render {
namespace {

using MatteChannels = std::array<int, 3>;

Image OnePixel(const MatteChannels& color) {
  Image image;
  image.width = image.height = 1;
  for (const int channel : color) image.rgba.push_back(static_cast<std::uint8_t>(channel));
  image.rgba.push_back(255);
  return image;
}

// `color` with `alpha` (0..1) over a grey, as a renderer blends and rounds it.
int Blended(int color, double alpha, int background) {
  return static_cast<int>(std::lround(alpha * color + (1 - alpha) * background));
}

std::array<int, 4> Matted(const MatteChannels& over_white, const MatteChannels& over_black) {
  Image picture = OnePixel(over_white);
  MatteOut(picture, OnePixel(over_black));
  return {picture.rgba[0], picture.rgba[1], picture.rgba[2], picture.rgba[3]};
}

TEST(Matte, KeepsTheColourOfOpaquePixels) {
  EXPECT_EQ(Matted({10, 200, 255}, {10, 200, 255}), (std::array<int, 4>{10, 200, 255, 255}));
  EXPECT_EQ(Matted({0, 0, 0}, {0, 0, 0}), (std::array<int, 4>{0, 0, 0, 255}));
}

TEST(Matte, MakesTheBackgroundTransparent) {
  EXPECT_EQ(Matted({255, 255, 255}, {0, 0, 0}), (std::array<int, 4>{0, 0, 0, 0}));
}

TEST(Matte, ComputesStraightColourAtHalfAlpha) {
  const auto [red, green, blue, alpha] = Matted({228, 178, 128}, {100, 50, 0});
  EXPECT_EQ(alpha, 127);
  EXPECT_NEAR(red, 200, 2);
  EXPECT_NEAR(green, 100, 2);
  EXPECT_NEAR(blue, 0, 2);
}

// Any colour at any alpha, also where rounding lets the channels disagree by a level.
TEST(Matte, RestoresThePictureOverWhiteToHalfALevel) {
  for (int level = 1; level <= 255; level += 2) {
    const double alpha = (level - 0.4) / 255;  // so that channels round apart
    for (const MatteChannels& color : {MatteChannels{0, 0, 0}, MatteChannels{255, 255, 255},
                                       MatteChannels{37, 128, 201}, MatteChannels{254, 1, 127}}) {
      MatteChannels over_white{}, over_black{};
      for (std::size_t i = 0; i < 3; ++i) {
        over_white[i] = Blended(color[i], alpha, 255);
        over_black[i] = Blended(color[i], alpha, 0);
      }
      const std::array<int, 4> matted = Matted(over_white, over_black);
      EXPECT_LE(std::abs(matted[3] - level), 1) << level;
      for (std::size_t i = 0; i < 3; ++i) {
        const double missing = (255 - matted[i]) * matted[3] / 255.0;
        EXPECT_NEAR(255 - missing, over_white[i], 0.5 + 1e-9) << "alpha " << level << ", " << i;
      }
    }
  }
}

TEST(Matte, ProcessesEveryPixelSeparately) {
  Image picture = OnePixel({255, 255, 255});
  picture.width = 2;
  picture.rgba.insert(picture.rgba.end(), {9, 8, 7, 255});
  Image black = OnePixel({0, 0, 0});
  black.width = 2;
  black.rgba.insert(black.rgba.end(), {9, 8, 7, 255});
  MatteOut(picture, black);
  EXPECT_EQ(picture.rgba, (std::vector<std::uint8_t>{0, 0, 0, 0, 9, 8, 7, 255}));
}

TEST(Matte, IsLaidOverAPictureByItsAlphaAndTheOpacity) {
  Image below = OnePixel({100, 100, 100});
  Image over = OnePixel({0, 0, 0});  // left of the part
  over.width = 2;
  over.rgba.insert(over.rgba.end(), {200, 0, 100, 255});
  const auto laid = [&](double opacity) {
    Image image = below;
    LayOver(image, over, {1, 0, 1, 1}, opacity);
    return image.rgba;
  };
  EXPECT_EQ(laid(1), (std::vector<std::uint8_t>{200, 0, 100, 255}));
  EXPECT_EQ(laid(0.25), (std::vector<std::uint8_t>{125, 75, 100, 255}));
  EXPECT_EQ(laid(0), below.rgba);
  over.rgba[7] = 51;  // a fifth
  EXPECT_EQ(laid(1), (std::vector<std::uint8_t>{120, 80, 100, 255}));
  over.rgba[7] = 0;
  EXPECT_EQ(laid(1), below.rgba);
}

}  // namespace
}  // namespace kinescope::render
