#include "render/image/yuv.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

namespace kinescope::render {
namespace {

constexpr int kPlaneWidth = 54, kPlaneHeight = 10;  // no multiple of a vector

struct Planes {
  std::vector<std::uint8_t> y = std::vector<std::uint8_t>(kPlaneWidth * kPlaneHeight);
  std::vector<std::uint8_t> u = std::vector<std::uint8_t>(kPlaneWidth * kPlaneHeight / 4);
  std::vector<std::uint8_t> v = u;

  YuvPlanes Borrow() {
    return {y.data(), u.data(), v.data(), kPlaneWidth, kPlaneWidth / 2, kPlaneWidth / 2};
  }
  bool operator==(const Planes& o) const { return y == o.y && u == o.u && v == o.v; }
};

Planes Convert(const Image& image) {
  Planes planes;
  ToYuv(image, 0, 0, kPlaneWidth, kPlaneHeight, planes.Borrow());
  return planes;
}

Image Noise(unsigned seed) {
  Image image;
  SetSize(image, kPlaneWidth, kPlaneHeight);
  std::mt19937 random(seed);
  for (std::uint8_t& level : image.rgba) level = static_cast<std::uint8_t>(random());
  return image;
}

Image Plain(std::array<std::uint8_t, 4> color) {
  Image image;
  SetSize(image, kPlaneWidth, kPlaneHeight);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) image.rgba[i] = color[i % 4];
  return image;
}

using Levels = std::array<int, 3>;

Levels LevelsOf(const Planes& planes) {
  return {planes.y.back(), planes.u.back(), planes.v.back()};
}

TEST(Yuv, IsTheBt709OfTheStandard) {
  EXPECT_EQ(LevelsOf(Convert(Plain({0, 0, 0, 255}))), (Levels{16, 128, 128}));
  EXPECT_EQ(LevelsOf(Convert(Plain({255, 255, 255, 255}))), (Levels{235, 128, 128}));
  EXPECT_EQ(LevelsOf(Convert(Plain({255, 0, 0, 255}))), (Levels{63, 102, 240}));
  EXPECT_EQ(LevelsOf(Convert(Plain({0, 255, 0, 255}))), (Levels{173, 42, 26}));
  EXPECT_EQ(LevelsOf(Convert(Plain({0, 0, 255, 255}))), (Levels{32, 240, 118}));
  for (int grey = 0; grey < 256; ++grey) {
    const auto level = static_cast<std::uint8_t>(grey);
    const Levels found = LevelsOf(Convert(Plain({level, level, level, 255})));
    EXPECT_EQ(found, (Levels{static_cast<int>(std::lround(16 + 219 * grey / 255.0)), 128, 128}));
  }
}

TEST(Yuv, IsWithinARoundingOfRealNumbers) {
  const Image image = Noise(1);
  const Planes planes = Convert(image);
  const auto at = [&](int x, int y, std::size_t channel) {
    return image.rgba[4 * static_cast<std::size_t>(y * kPlaneWidth + x) + channel] / 255.0;
  };
  const auto luma = [](double r, double g, double b) {
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  for (int y = 0; y < kPlaneHeight; ++y) {
    for (int x = 0; x < kPlaneWidth; ++x) {
      EXPECT_NEAR(planes.y[static_cast<std::size_t>(y * kPlaneWidth + x)],
                  16 + 219 * luma(at(x, y, 0), at(x, y, 1), at(x, y, 2)), 0.51);
      if (x % 2 != 0 || y % 2 != 0) continue;
      std::array<double, 3> mean{};
      for (std::size_t i = 0; i < 3; ++i) {
        mean[i] = (at(x, y, i) + at(x + 1, y, i) + at(x, y + 1, i) + at(x + 1, y + 1, i)) / 4;
      }
      const double of_mean = luma(mean[0], mean[1], mean[2]);
      const auto uv = static_cast<std::size_t>(y / 2 * kPlaneWidth / 2 + x / 2);
      EXPECT_NEAR(planes.u[uv], 128 + 224 * (mean[2] - of_mean) / 1.8556, 0.51);
      EXPECT_NEAR(planes.v[uv], 128 + 224 * (mean[0] - of_mean) / 1.5748, 0.51);
    }
  }
}

TEST(Yuv, OfPartsIsThatOfTheWhole) {
  const Image image = Noise(2);
  Planes planes;
  for (int y = 0; y < kPlaneHeight; y += 2) {
    for (int x = 0; x < kPlaneWidth; x += 18) {
      ToYuv(image, x, y, 18, 2, planes.Borrow());
    }
  }
  EXPECT_TRUE(planes == Convert(image));
}

TEST(Yuv, LeavesTheRestAlone) {
  Planes planes;
  ToYuv(Plain({255, 255, 255, 255}), 4, 2, 6, 4, planes.Borrow());
  EXPECT_EQ(std::count(planes.y.begin(), planes.y.end(), 235), 6 * 4);
  EXPECT_EQ(planes.y[2 * kPlaneWidth + 4], 235);
  EXPECT_EQ(planes.y[5 * kPlaneWidth + 9], 235);
  EXPECT_EQ(std::count(planes.u.begin(), planes.u.end(), 128), 3 * 2);
  EXPECT_EQ(planes.u[kPlaneWidth / 2 + 2], 128);
}

TEST(Yuv, DoesNotDependOnAlpha) {
  Image image = Noise(3);
  const Planes before = Convert(image);
  for (std::size_t i = 3; i < image.rgba.size(); i += 4) image.rgba[i] ^= 0xFF;
  EXPECT_TRUE(Convert(image) == before);
}

// Also of another compiler, or without the wide vectors of this processor.
TEST(Yuv, HasTheSameBytesEverywhere) {
  const Planes planes = Convert(Noise(4));
  unsigned long sum = 0;
  for (const auto* plane : {&planes.y, &planes.u, &planes.v}) {
    sum = ::crc32(sum, plane->data(), static_cast<unsigned>(plane->size()));
  }
  EXPECT_EQ(sum, 1770474248u);
}

TEST(Yuv, CopiesAlpha) {
  const Image image = Noise(5);
  std::vector<std::uint8_t> plane(kPlaneWidth * kPlaneHeight);
  CopyAlpha(image, plane.data(), kPlaneWidth);
  for (std::size_t i = 0; i < plane.size(); ++i) ASSERT_EQ(plane[i], image.rgba[4 * i + 3]);
}

}  // namespace
}  // namespace kinescope::render
