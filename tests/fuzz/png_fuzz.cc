// Any bytes as a PNG file, and any bytes as its pixels before their filters are undone: refused, or
// read as libpng reads it.
#include <png.h>
#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/system/check.h"
#include "render/image/plain_png.h"

namespace png_fuzz {
namespace {

using namespace kinescope;
using Bytes = std::vector<std::uint8_t>;

constexpr int kMostSide = 256;  // px

void AppendBigEndian(std::uint32_t value, Bytes& out) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(value >> shift));
}

void AppendChunk(const std::string& type, const Bytes& data, Bytes& out) {
  AppendBigEndian(static_cast<std::uint32_t>(data.size()), out);
  const std::size_t begin = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  AppendBigEndian(
      static_cast<std::uint32_t>(crc32(0, &out[begin], static_cast<uInt>(out.size() - begin))),
      out);
}

// A file whose check sums are right.
Bytes FileOf(const std::uint8_t* filtered, std::size_t size, int width, int channels) {
  Bytes out = {137, 80, 78, 71, 13, 10, 26, 10}, header;
  const std::size_t row = 1 + static_cast<std::size_t>(width * channels);
  AppendBigEndian(static_cast<std::uint32_t>(width), header);
  AppendBigEndian(static_cast<std::uint32_t>(size / row), header);
  header.insert(header.end(), {8, static_cast<std::uint8_t>(channels == 3 ? 2 : 6), 0, 0, 0});
  AppendChunk("IHDR", header, out);
  uLongf compressed_size = compressBound(static_cast<uLong>(size));
  Bytes compressed(compressed_size);
  compress(compressed.data(), &compressed_size, filtered, static_cast<uLong>(size / row * row));
  compressed.resize(compressed_size);
  AppendChunk("IDAT", compressed, out);
  AppendChunk("IEND", {}, out);
  return out;
}

void Check(const std::uint8_t* data, std::size_t size) {
  render::Image image;
  if (!render::ReadPlainPng(data, size, kMostSide, image)) return;
  png_image expected = {};
  expected.version = PNG_IMAGE_VERSION;
  KINESCOPE_CHECK(png_image_begin_read_from_memory(&expected, data, size) != 0);
  expected.format = PNG_FORMAT_RGBA;
  Bytes pixels(PNG_IMAGE_SIZE(expected));
  KINESCOPE_CHECK(png_image_finish_read(&expected, nullptr, pixels.data(), 0, nullptr) != 0);
  KINESCOPE_CHECK(image.width == static_cast<int>(expected.width) && image.rgba == pixels);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Check(data, size);
  if (size < 3) return 0;
  const Bytes file = FileOf(data + 2, size - 2, 1 + data[0] % 100, data[1] % 2 == 0 ? 3 : 4);
  Check(file.data(), file.size());
  return 0;
}

}  // namespace png_fuzz
