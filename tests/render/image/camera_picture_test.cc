#include "render/image/camera_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "render/image/png_file.h"

namespace kinescope::render {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

CameraImage ImageOf(const std::string& encoding, int width, int height,
                    std::vector<std::uint8_t> bytes) {
  CameraImage image;
  image.encoding = encoding;
  image.width = width;
  image.height = height;
  image.row_bytes = bytes.size() / static_cast<std::size_t>(height);
  image.size = bytes.size();
  image.bytes = std::make_shared<const std::vector<std::uint8_t>>(std::move(bytes));
  return image;
}

std::array<int, 3> At(const Image& image, int x, int y) {
  const auto at = 4 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

std::vector<int> GreysOf(const CameraImage& image) {
  const auto decoded = DecodeCameraImage(image, image.width, image.height);
  std::vector<int> greys;
  if (!decoded) return greys;
  for (int x = 0; x < decoded->width; ++x) greys.push_back(At(*decoded, x, 0)[0]);
  return greys;
}

TEST(CameraPicture, HasTheColoursOfEachEncoding) {
  const std::vector<std::uint8_t> bytes = {10, 20, 30, 200, 40, 50, 60, 200};
  const auto first = [&](const std::string& encoding, int width) {
    return At(*DecodeCameraImage(ImageOf(encoding, width, 1, bytes), width, 1), 0, 0);
  };
  EXPECT_THAT(first("rgb8", 2), ElementsAre(10, 20, 30));
  EXPECT_THAT(first("bgr8", 2), ElementsAre(30, 20, 10));
  EXPECT_THAT(first("rgba8", 2), ElementsAre(10, 20, 30));
  EXPECT_THAT(first("bgra8", 2), ElementsAre(30, 20, 10));
  EXPECT_THAT(first("mono8", 8), ElementsAre(10, 10, 10));
  EXPECT_THAT(first("bayer_rggb8", 8), ElementsAre(10, 10, 10));
  const auto yuv = [](const char* encoding, std::vector<std::uint8_t> pixels) {
    return At(*DecodeCameraImage(ImageOf(encoding, 2, 1, std::move(pixels)), 2, 1), 1, 0);
  };
  EXPECT_THAT(yuv("yuv422", {128, 50, 128, 90}), ElementsAre(90, 90, 90)) << "u y v y";
  EXPECT_THAT(yuv("yuv422_yuy2", {50, 128, 90, 128}), ElementsAre(90, 90, 90)) << "y u y v";
  EXPECT_THAT(yuv("yuv422", {128, 76, 255, 76}), ElementsAre(254, 0, 76)) << "red";
}

TEST(CameraPicture, HasGreysBetweenTheLeastAndTheLargestNumber) {
  const std::vector<std::uint8_t> little = {0, 0, 0, 4, 0, 2, 0, 1, 0, 3};
  EXPECT_THAT(GreysOf(ImageOf("16UC1", 5, 1, little)), ElementsAre(0, 255, 128, 64, 191));
  CameraImage big = ImageOf("mono16", 5, 1, {0, 0, 4, 0, 2, 0, 1, 0, 3, 0});
  big.is_bigendian = true;
  EXPECT_THAT(GreysOf(big), ElementsAre(0, 255, 128, 64, 191));
  std::vector<std::uint8_t> floats(5 * 4);
  const std::array<float, 5> metres = {2, std::numeric_limits<float>::quiet_NaN(), 1,
                                       std::numeric_limits<float>::infinity(), 1.5};
  std::memcpy(floats.data(), metres.data(), floats.size());
  EXPECT_THAT(GreysOf(ImageOf("32FC1", 5, 1, floats)), ElementsAre(255, 0, 0, 255, 128));
}

TEST(CameraPicture, IsShrunkOrEnlargedWithItsProportions) {
  std::vector<std::uint8_t> bytes(400 * 200, 0);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = i % 2 == 0 ? 0 : 200;
  const CameraImage image = ImageOf("mono8", 400, 200, bytes);
  const auto small = DecodeCameraImage(image, 100, 100);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->width, 100);
  EXPECT_EQ(small->height, 50);
  EXPECT_THAT(At(*small, 7, 7), ElementsAre(100, 100, 100)) << "averaged";
  EXPECT_EQ(DecodeCameraImage(image, 1000, 1000)->height, 500);
}

TEST(CameraPicture, ThatLiesIsRefused) {
  CameraImage image = ImageOf("rgb8", 2, 2, std::vector<std::uint8_t>(12));
  EXPECT_EQ(FindDefect(image), "");
  CameraImage bad = image;
  bad.height = 3;
  EXPECT_EQ(FindDefect(bad), "it states more pixels than it has");
  bad = image;
  bad.row_bytes = 5;
  EXPECT_EQ(FindDefect(bad), "it states more pixels than it has");
  bad = image;
  bad.row_bytes = std::numeric_limits<std::size_t>::max();
  EXPECT_EQ(FindDefect(bad), "it states more pixels than it has");
  bad = image;
  bad.begin = 1;
  EXPECT_EQ(FindDefect(bad), "it states more bytes than it has");
  bad = image;
  bad.width = 20'000;
  EXPECT_THAT(FindDefect(bad), HasSubstr("20000 x 2 px"));
  bad = image;
  bad.encoding = "\x1b[31m" + std::string(100, 'x');
  EXPECT_THAT(FindDefect(bad), HasSubstr("expected rgb8"));
  EXPECT_LT(FindDefect(bad).size(), 200u);
  EXPECT_EQ(FindDefect(bad).find('\x1b'), std::string::npos);
  EXPECT_EQ(FindDefect(CameraImage()), "no pixels");
  EXPECT_FALSE(DecodeCameraImage(bad, 10, 10));
}

TEST(CameraPicture, MayBeAJpeg) {
  Image red;
  SetSize(red, 400, 300);
  for (std::size_t i = 0; i < red.rgba.size(); ++i)
    red.rgba[i] = i % 4 == 0 || i % 4 == 3 ? 255 : 0;
  const std::vector<std::uint8_t> file = EncodeJpeg(red, 90);
  CameraImage image = ImageOf("jpeg", 0, 1, file);
  image.height = 0;
  const auto decoded = DecodeCameraImage(image, 80, 80);
  ASSERT_TRUE(decoded) << decoded.error();
  EXPECT_EQ(decoded->width, 80);
  EXPECT_EQ(decoded->height, 60);
  EXPECT_GT(At(*decoded, 40, 30)[0], 245);
  EXPECT_LT(At(*decoded, 40, 30)[1], 12);
  // At each length: refused, or with what is there.
  for (std::size_t size = 1; size < file.size(); size += 7) {
    image.size = size;
    const auto part = DecodeCameraImage(image, 80, 80);
    if (!part) EXPECT_THAT(part.error(), HasSubstr("JPEG: "));
  }
  EXPECT_THAT(DecodeCameraImage(ImageOf("jpeg", 0, 1, {1, 2, 3}), 80, 80).error(),
              HasSubstr("JPEG: "));
}

// Of Python's zlib, without libpng: 3 x 2 px of 16 bits, 1000, 2000, 3000 and 3000, 1500, 1000.
const std::vector<std::uint8_t> kDepthPng = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52,
    0x00, 0x00, 0x00, 0x03, 0x00, 0x00, 0x00, 0x02, 0x10, 0x00, 0x00, 0x00, 0x00, 0xe8, 0x8f, 0xe5,
    0x85, 0x00, 0x00, 0x00, 0x16, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60, 0x7e, 0xc1, 0x7e,
    0x81, 0x7b, 0x07, 0x03, 0xf7, 0x0e, 0xd6, 0x3b, 0xcc, 0x2f, 0x00, 0x21, 0x15, 0x05, 0x15, 0x34,
    0x99, 0x45, 0xa0, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST(CameraPicture, MayBeAPng) {
  Image red;
  SetSize(red, 40, 30);
  for (std::size_t i = 0; i < red.rgba.size(); ++i)
    red.rgba[i] = i % 4 == 0 || i % 4 == 3 ? 255 : 0;
  const std::vector<std::uint8_t> file = EncodePng(red);
  CameraImage image = ImageOf("png", 0, 1, file);
  image.height = 0;
  const auto decoded = DecodeCameraImage(image, 20, 20);
  ASSERT_TRUE(decoded) << decoded.error();
  EXPECT_EQ(decoded->width, 20);
  EXPECT_EQ(decoded->height, 15);
  EXPECT_EQ(At(*decoded, 10, 7)[0], 255);
  EXPECT_EQ(At(*decoded, 10, 7)[1], 0);

  const auto depth = DecodeCameraImage(ImageOf("png", 0, 1, kDepthPng), 3, 2);
  ASSERT_TRUE(depth) << depth.error();
  EXPECT_EQ(At(*depth, 0, 0)[0], 0) << "the nearest";
  EXPECT_EQ(At(*depth, 1, 0)[0], 128);
  EXPECT_EQ(At(*depth, 2, 0)[0], 255);
  EXPECT_EQ(At(*depth, 1, 1)[0], 64);
}

TEST(CameraPicture, OfADamagedPngIsRefused) {
  for (std::size_t size = 1; size < kDepthPng.size() - 12; ++size) {
    CameraImage image = ImageOf("png", 0, 1, kDepthPng);
    image.size = size;
    EXPECT_FALSE(DecodeCameraImage(image, 80, 80)) << size;
  }
  EXPECT_THAT(DecodeCameraImage(ImageOf("png", 0, 1, {1, 2, 3}), 80, 80).error(),
              HasSubstr("PNG: "));
  std::vector<std::uint8_t> large = kDepthPng;
  large[18] = large[22] = 0x20;  // 8,192 px each, and the checksum for it
  large[19] = large[23] = 0;
  const std::array<std::uint8_t, 4> sum = {0x07, 0x51, 0x49, 0xc6};
  std::copy(sum.begin(), sum.end(), large.begin() + 29);
  EXPECT_EQ(DecodeCameraImage(ImageOf("png", 0, 1, large), 80, 80).error(),
            "PNG: 8192 x 8192 px are more than 16777216");
}

}  // namespace
}  // namespace kinescope::render
