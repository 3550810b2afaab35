#include "render/image/plain_png.h"

#include <libdeflate.h>

#include <array>
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

// The levels of a pixel, so that the processor computes with all of them at once.
using Levels = std::uint8_t __attribute__((vector_size(4)));
using WideLevels = std::int16_t __attribute__((vector_size(8)));

Levels LevelsAt(const std::uint8_t* bytes) {
  Levels levels;
  std::memcpy(&levels, bytes, sizeof levels);
  return levels;
}

WideLevels Wide(Levels levels) { return __builtin_convertvector(levels, WideLevels); }

Levels Average(Levels left, Levels above) {
  return (left & above) + ((left ^ above) >> 1);  // without a ninth bit
}

WideLevels Distance(WideLevels difference) { return difference < 0 ? -difference : difference; }

// Of the PNG specification, section 9.4.
Levels Paeth(Levels left, Levels above, Levels above_left) {
  const WideLevels from_left_side = Wide(left) - Wide(above_left),
                   from_above_side = Wide(above) - Wide(above_left);
  const WideLevels from_left = Distance(from_above_side), from_above = Distance(from_left_side),
                   from_corner = Distance(from_left_side + from_above_side);
  const WideLevels nearer = from_above <= from_corner ? Wide(above) : Wide(above_left);
  const WideLevels nearest =
      ((from_left <= from_above) & (from_left <= from_corner)) ? Wide(left) : nearer;
  return __builtin_convertvector(nearest, Levels);
}

// A row of RGBA from differences to what `predict` makes of its neighbours; `above` is the row
// above. With three channels it reads one byte beyond the row.
template <std::size_t kChannels, class Predict>
void UnfilterRow(const std::uint8_t* differences, std::size_t width, const std::uint8_t* above,
                 std::uint8_t* rgba, const Predict& predict) {
  constexpr Levels kOpaque = {0, 0, 0, kChannels == 3 ? 255 : 0};
  Levels left{}, above_left{};
  for (std::size_t x = 0; x < width; ++x, differences += kChannels, above += 4, rgba += 4) {
    const Levels up = LevelsAt(above);
    left = (LevelsAt(differences) + predict(left, up, above_left)) | kOpaque;
    above_left = up;
    std::memcpy(rgba, &left, sizeof left);
  }
}

template <std::size_t kChannels>
bool UnfilterRow(int filter, const std::uint8_t* differences, std::size_t width,
                 const std::uint8_t* above, std::uint8_t* rgba) {
  const auto unfilter = [&](const auto& predict) {
    UnfilterRow<kChannels>(differences, width, above, rgba, predict);
    return true;
  };
  switch (filter) {
    case 0: return unfilter([](Levels, Levels, Levels) { return Levels{}; });
    case 1: return unfilter([](Levels left, Levels, Levels) { return left; });
    case 2: return unfilter([](Levels, Levels up, Levels) { return up; });
    case 3: return unfilter([](Levels left, Levels up, Levels) { return Average(left, up); });
    case 4: return unfilter(Paeth);
    default: return false;
  }
}

template <std::size_t kChannels>
bool UnfilterAll(const PlainPng& png, const std::uint8_t* filtered, std::uint8_t* rgba) {
  const std::vector<std::uint8_t> zeros(4 * png.width);
  const std::uint8_t* above = zeros.data();
  for (std::size_t y = 0; y < png.height; ++y) {
    if (!UnfilterRow<kChannels>(*filtered, filtered + 1, png.width, above, rgba)) return false;
    above = rgba;
    filtered += 1 + png.row_bytes();
    rgba += 4 * png.width;
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
  // One more: the last pixel of three channels is read as four.
  const std::unique_ptr<std::uint8_t[]> filtered(new std::uint8_t[png.filtered_size() + 1]);
  filtered[png.filtered_size()] = 0;
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
