#include "render/image/plain_png.h"

#include <gtest/gtest.h>
#include <png.h>

#include <random>
#include <vector>

namespace kinescope::render {
namespace {

using Bytes = std::vector<std::uint8_t>;

Image Gradient(int width, int height, bool has_alpha) {
  Image image;
  SetSize(image, width, height);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    const std::size_t pixel = i / 4;
    image.rgba[i] = static_cast<std::uint8_t>(pixel + 40 * (i % 4) + random() % 5);
    if (i % 4 == 3 && !has_alpha) image.rgba[i] = 255;
  }
  return image;
}

struct Kind {
  int filters = PNG_ALL_FILTERS;
  bool has_alpha = false;
  int interlace = PNG_INTERLACE_NONE;
  bool has_gamma = false, is_srgb = false;
  bool has_transparent_color = false;
  std::size_t chunk_size = 8192;
};

void Append(png_structp png, png_bytep data, png_size_t size) {
  auto* out = static_cast<Bytes*>(png_get_io_ptr(png));
  out->insert(out->end(), data, data + size);
}

Bytes Encode(const Image& image, const Kind& kind) {
  Bytes out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(png, &out, Append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width),
               static_cast<png_uint_32>(image.height), 8,
               kind.has_alpha ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB, kind.interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, kind.filters);
  png_set_compression_buffer_size(png, kind.chunk_size);
  if (kind.has_gamma) png_set_gAMA(png, info, kind.is_srgb ? 0.45455 : 1.0);
  if (kind.is_srgb) png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  if (kind.has_transparent_color) {
    const png_color_16 transparent = {0, 1, 2, 3, 0};
    png_set_tRNS(png, info, nullptr, 0, &transparent);
  }
  png_write_info(png, info);
  if (!kind.has_alpha) png_set_filler(png, 0, PNG_FILLER_AFTER);
  std::vector<png_bytep> rows;
  for (int y = 0; y < image.height; ++y) {
    rows.push_back(const_cast<png_bytep>(image.rgba.data()) + std::ptrdiff_t{4} * y * image.width);
  }
  png_write_image(png, rows.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

bool Read(const Bytes& bytes, Image& image) {
  return ReadPlainPng(bytes.data(), bytes.size(), 16384, image);
}

TEST(PlainPng, IsReadWithEachFilter) {
  for (const bool has_alpha : {false, true}) {
    for (const int filters : {PNG_FILTER_NONE, PNG_FILTER_SUB, PNG_FILTER_UP, PNG_FILTER_AVG,
                              PNG_FILTER_PAETH, PNG_ALL_FILTERS}) {
      for (const int width : {1, 2, 57}) {
        const Image image = Gradient(width, 23, has_alpha);
        Image back;
        ASSERT_TRUE(Read(Encode(image, {filters, has_alpha}), back)) << filters;
        EXPECT_EQ(back.rgba, image.rgba) << filters << ", " << width << " px, " << has_alpha;
        EXPECT_EQ(back.width, width);
        EXPECT_EQ(back.is_opaque, !has_alpha);
      }
    }
  }
}

TEST(PlainPng, IsReadFromSeveralChunks) {
  const Image image = Gradient(90, 40, false);
  Kind kind;
  kind.chunk_size = 100;
  Image back;
  ASSERT_TRUE(Read(Encode(image, kind), back));
  EXPECT_EQ(back.rgba, image.rgba);
}

TEST(PlainPng, IsNoneWhosePixelsDependOnMore) {
  const Image image = Gradient(16, 16, false);
  Image back;
  Kind kind;
  kind.interlace = PNG_INTERLACE_ADAM7;
  EXPECT_FALSE(Read(Encode(image, kind), back)) << "interlaced";
  kind = {};
  kind.has_gamma = true;
  EXPECT_FALSE(Read(Encode(image, kind), back)) << "gamma";
  kind.is_srgb = true;
  EXPECT_TRUE(Read(Encode(image, kind), back)) << "gamma that sRGB overrules";
  kind = {};
  kind.has_transparent_color = true;
  EXPECT_FALSE(Read(Encode(image, kind), back)) << "one transparent colour";
  EXPECT_FALSE(ReadPlainPng(Encode(image, {}).data(), Encode(image, {}).size(), 15, back));
}

TEST(PlainPng, IsNotReadWithAnyByteChanged) {
  const Bytes whole = Encode(Gradient(20, 9, true), {PNG_ALL_FILTERS, true});
  std::mt19937 random(11);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    Bytes bytes = whole;
    bytes[at] ^= static_cast<std::uint8_t>(1 + random() % 255);
    Image image;
    image.width = -1;
    EXPECT_FALSE(Read(bytes, image)) << "byte " << at;
    EXPECT_EQ(image.width, -1) << "untouched";
    bytes = whole;
    bytes.resize(at);
    EXPECT_FALSE(Read(bytes, image)) << "cut to " << at;
  }
}

}  // namespace
}  // namespace kinescope::render
