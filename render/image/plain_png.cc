#include "render/image/plain_png.h"

#include <libdeflate.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace kinescope::render {
namespace {

constexpr std::size_t kMostCompression = 1032;  // bytes per byte that Deflate can reach

std::uint32_t BigEndian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | std::uint32_t{bytes[1]} << 16 |
         std::uint32_t{bytes[2]} << 8 | bytes[3];
}

struct Chunk {
  std::string_view type;
  const std::uint8_t* data = nullptr;
  std::size_t size = 0;
};

// Nothing if the chunk is cut off or its check sum is wrong. Moves `at` behind it.
std::optional<Chunk> TakeChunk(const std::uint8_t* bytes, std::size_t size, std::size_t& at) {
  constexpr std::size_t kFrame = 12;  // size, type and check sum
  if (size - at < kFrame) return std::nullopt;
  const std::size_t data_size = BigEndian(bytes + at);
  if (data_size > size - at - kFrame) return std::nullopt;
  const std::uint8_t* const type = bytes + at + 4;
  if (libdeflate_crc32(0, type, 4 + data_size) != BigEndian(type + 4 + data_size)) {
    return std::nullopt;
  }
  at += kFrame + data_size;
  return Chunk{{reinterpret_cast<const char*>(type), 4}, type + 4, data_size};
}

// Neither colours nor transparency depend on it. Others, such as colour profiles, are for libpng.
bool ChangesNoPixels(std::string_view type) {
  for (const char* name : {"sRGB", "tEXt", "zTXt", "iTXt", "pHYs", "tIME"}) {
    if (type == name) return true;
  }
  return false;
}

struct PlainPng {
  std::size_t width = 0, height = 0;  // px
  std::size_t channels = 0;           // 3 or 4
  std::vector<std::uint8_t> joined;   // the compressed pixels, if they are in several chunks
  const std::uint8_t* compressed = nullptr;
  std::size_t compressed_size = 0;
  std::size_t row_bytes() const { return width * channels; }
  std::size_t filtered_size() const { return height * (1 + row_bytes()); }
};

bool TakeHeader(const Chunk& chunk, int most_side, PlainPng& png) {
  if (chunk.type != "IHDR" || chunk.size != 13) return false;
  png.width = BigEndian(chunk.data);
  png.height = BigEndian(chunk.data + 4);
  const std::uint8_t bits = chunk.data[8], color = chunk.data[9];
  if (bits != 8 || (color != 2 && color != 6)) return false;
  if (chunk.data[10] != 0 || chunk.data[11] != 0 || chunk.data[12] != 0) return false;
  png.channels = color == 2 ? 3 : 4;
  const auto most = static_cast<std::size_t>(most_side);
  return png.width > 0 && png.height > 0 && png.width <= most && png.height <= most;
}

void Append(const Chunk& chunk, PlainPng& png) {
  if (png.compressed == nullptr) {
    png.compressed = chunk.data;
    png.compressed_size = chunk.size;
    return;
  }
  if (png.joined.empty()) {
    png.joined.assign(png.compressed, png.compressed + png.compressed_size);
  }
  png.joined.insert(png.joined.end(), chunk.data, chunk.data + chunk.size);
  png.compressed = png.joined.data();
  png.compressed_size = png.joined.size();
}

bool Parse(const std::uint8_t* bytes, std::size_t size, int most_side, PlainPng& png) {
  constexpr std::array<std::uint8_t, 8> kSignature = {137, 80, 78, 71, 13, 10, 26, 10};
  if (size < kSignature.size() || std::memcmp(bytes, kSignature.data(), kSignature.size()) != 0) {
    return false;
  }
  std::size_t at = kSignature.size();
  std::optional<Chunk> chunk = TakeChunk(bytes, size, at);
  if (!chunk || !TakeHeader(*chunk, most_side, png)) return false;
  bool is_srgb = false, has_gamma = false;
  while ((chunk = TakeChunk(bytes, size, at))) {
    if (chunk->type == "IEND") {
      return png.compressed != nullptr && (is_srgb || !has_gamma);  // sRGB overrules gamma
    }
    if (chunk->type == "IDAT") {
      Append(*chunk, png);
    } else if (chunk->type == "gAMA" || chunk->type == "cHRM") {
      has_gamma = true;
    } else if (ChangesNoPixels(chunk->type)) {
      is_srgb = is_srgb || chunk->type == "sRGB";
    } else {
      return false;
    }
  }
  return false;
}

int Paeth(int left, int up, int up_left) {
  const int from_left = std::abs(up - up_left), from_up = std::abs(left - up_left);
  const int from_up_left = std::abs(left + up - 2 * up_left);
  if (from_left <= from_up && from_left <= from_up_left) return left;
  return from_up <= from_up_left ? up : up_left;
}

// Replaces the differences in `row` by levels. `up` is the row above it, or zeros.
template <std::size_t kChannels>
bool Unfilter(int filter, std::uint8_t* row, const std::uint8_t* up, std::size_t bytes) {
  const auto add = [&](const auto& predicted) {
    for (std::size_t i = 0; i < bytes; ++i) {
      const int left = i >= kChannels ? row[i - kChannels] : 0;
      const int up_left = i >= kChannels ? up[i - kChannels] : 0;
      row[i] = static_cast<std::uint8_t>(row[i] + predicted(left, int{up[i]}, up_left));
    }
  };
  switch (filter) {
    case 0: return true;
    case 1: add([](int left, int, int) { return left; }); return true;
    case 2: add([](int, int above, int) { return above; }); return true;
    case 3: add([](int left, int above, int) { return (left + above) / 2; }); return true;
    case 4: add(Paeth); return true;
    default: return false;
  }
}

void SpreadRgb(const std::uint8_t* rgb, std::size_t count, std::uint8_t* rgba) {
  for (std::size_t i = 0; i < count; ++i) {
    rgba[4 * i] = rgb[3 * i];
    rgba[4 * i + 1] = rgb[3 * i + 1];
    rgba[4 * i + 2] = rgb[3 * i + 2];
    rgba[4 * i + 3] = 255;
  }
}

template <std::size_t kChannels>
bool UnfilterAll(const PlainPng& png, std::uint8_t* filtered, std::uint8_t* rgba) {
  const std::size_t bytes = png.row_bytes();
  const std::vector<std::uint8_t> zeros(bytes);
  const std::uint8_t* up = zeros.data();
  for (std::size_t y = 0; y < png.height; ++y, filtered += 1 + bytes, rgba += 4 * png.width) {
    std::uint8_t* const row = filtered + 1;
    if (!Unfilter<kChannels>(*filtered, row, up, bytes)) return false;
    up = row;
    if (kChannels == 3) {
      SpreadRgb(row, png.width, rgba);
    } else {
      std::memcpy(rgba, row, bytes);
    }
  }
  return true;
}

bool Inflate(const PlainPng& png, std::uint8_t* filtered) {
  struct Free {
    void operator()(libdeflate_decompressor* d) const { libdeflate_free_decompressor(d); }
  };
  const std::unique_ptr<libdeflate_decompressor, Free> decompressor(
      libdeflate_alloc_decompressor());
  return decompressor != nullptr &&
         libdeflate_zlib_decompress(decompressor.get(), png.compressed, png.compressed_size,
                                    filtered, png.filtered_size(),
                                    nullptr) == LIBDEFLATE_SUCCESS;  // exactly that size
}

}  // namespace

bool ReadPlainPng(const std::uint8_t* bytes, std::size_t size, int most_side, Image& image) {
  PlainPng png;
  if (!Parse(bytes, size, most_side, png)) return false;
  if (png.filtered_size() / kMostCompression > png.compressed_size) return false;
  const std::unique_ptr<std::uint8_t[]> filtered(new std::uint8_t[png.filtered_size()]);
  if (!Inflate(png, filtered.get())) return false;
  Image read;
  SetSize(read, static_cast<int>(png.width), static_cast<int>(png.height));
  read.is_opaque = png.channels == 3;
  const bool is_whole = png.channels == 3 ? UnfilterAll<3>(png, filtered.get(), read.rgba.data())
                                          : UnfilterAll<4>(png, filtered.get(), read.rgba.data());
  if (is_whole) image = std::move(read);
  return is_whole;
}

}  // namespace kinescope::render
