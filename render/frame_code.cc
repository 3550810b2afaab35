#include "render/frame_code.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kinescope::render {
namespace {

constexpr std::uint8_t kMark = 0b10110100;
constexpr std::size_t kBytes = kFrameCodeBits / 8, kCheckBytes = 3;
constexpr double kNarrowestCell = 5.5;  // px; half of it still outlives an encoder
constexpr int kLowestRow = 6, kRowsOfPicture = 90;
constexpr int kMaxRows = 8;

using Bytes = std::array<std::uint8_t, kBytes>;

std::uint32_t CheckOf(const Bytes& bytes) {
  return static_cast<std::uint32_t>(::crc32(0, bytes.data() + 1, kBytes - 1 - kCheckBytes)) &
         0xFFFFFF;
}

Bytes Encode(const FrameCode& code) {
  Bytes bytes{kMark};
  const auto put = [&](std::size_t at, std::size_t count, std::uint64_t value) {
    for (std::size_t i = 0; i < count; ++i) {
      bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * (count - 1 - i)));
    }
  };
  put(1, 4, code.counter);
  put(5, 6, static_cast<std::uint64_t>(code.time_code_millis));
  put(11, 3, CheckOf(bytes));
  return bytes;
}

std::optional<FrameCode> Decode(const Bytes& bytes) {
  const auto take = [&](std::size_t at, std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[at + i];
    return value;
  };
  if (bytes[0] != kMark || take(11, 3) != CheckOf(bytes)) return std::nullopt;
  FrameCode code;
  code.counter = static_cast<std::uint32_t>(take(1, 4));
  const std::uint64_t time = take(5, 6);
  const std::uint64_t sign = std::uint64_t{1} << 47;
  code.time_code_millis = static_cast<std::int64_t>((time ^ sign) - sign);
  return code;
}

bool BitOf(const Bytes& bytes, int bit) {
  return (bytes[static_cast<std::size_t>(bit / 8)] >> (7 - bit % 8) & 1) != 0;
}

// Mean brightness of the middle of a cell, levels. @pre the box meets the image
double BrightnessOf(const Image& image, double left, double top, double width, double height) {
  // A quarter off each side: there the encoder and the scaler have mixed neighbours.
  const auto range = [](double from, double length, int size) {
    const int first = std::clamp(static_cast<int>(std::floor(from + 0.3 * length)), 0, size - 1);
    const int last =
        std::clamp(static_cast<int>(std::ceil(from + 0.7 * length)) - 1, first, size - 1);
    return std::pair(first, last);
  };
  const auto [x0, x1] = range(left, width, image.width);
  const auto [y0, y1] = range(top, height, image.height);
  double sum = 0;
  for (int y = y0; y <= y1; ++y) {
    for (int x = x0; x <= x1; ++x) {
      const auto at = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                           static_cast<std::size_t>(x));
      sum += image.rgba[at] + image.rgba[at + 1] + image.rgba[at + 2];
    }
  }
  return sum / (3.0 * (x1 - x0 + 1) * (y1 - y0 + 1));
}

std::optional<FrameCode> ReadAt(const Image& image, int shrunk) {
  const FrameCodeLayout layout = FrameCodeLayoutOf(image.width * shrunk, image.height * shrunk);
  const int cells = kFrameCodeBits / layout.rows;
  const double cell = static_cast<double>(image.width) / cells;
  const double row_height = static_cast<double>(layout.row_height) / shrunk;
  const double top = image.height - layout.rows * row_height;
  std::array<double, kFrameCodeBits> levels{};
  for (int bit = 0; bit < kFrameCodeBits; ++bit) {
    const int row = bit / cells;
    levels[static_cast<std::size_t>(bit)] =
        BrightnessOf(image, bit % cells * cell, top + row * row_height, cell, row_height);
  }
  // The mark has both colours; an encoder may have moved either.
  const auto [darkest, lightest] = std::minmax_element(levels.begin(), levels.begin() + 8);
  const double threshold = (*darkest + *lightest) / 2;
  Bytes bytes{};
  for (std::size_t bit = 0; bit < levels.size(); ++bit) {
    if (levels[bit] > threshold) bytes[bit / 8] |= static_cast<std::uint8_t>(0x80 >> bit % 8);
  }
  return Decode(bytes);
}

}  // namespace

FrameCodeLayout FrameCodeLayoutOf(int width_px, int height_px) {
  FrameCodeLayout layout;
  while (layout.rows < kMaxRows && width_px * layout.rows < kNarrowestCell * kFrameCodeBits) {
    layout.rows *= 2;
  }
  // Even, so that half of it is whole.
  layout.row_height = std::max(kLowestRow, height_px / kRowsOfPicture / 2 * 2);
  return layout;
}

void PaintFrameCode(Painter& painter, int width_px, int height_px, const FrameCode& code) {
  const FrameCodeLayout layout = FrameCodeLayoutOf(width_px, height_px);
  const Bytes bytes = Encode(code);
  const int cells = kFrameCodeBits / layout.rows;
  const auto edge = [&](int cell) {
    return std::round(static_cast<double>(width_px) * cell / cells);
  };
  const double top = height_px - layout.height();
  painter.RoundedBox(0, top, width_px, layout.height(), 0, {{0, 0, 0}, 1});
  for (int bit = 0; bit < kFrameCodeBits; ++bit) {
    if (!BitOf(bytes, bit)) continue;
    const int cell = bit % cells, row = bit / cells;
    painter.RoundedBox(edge(cell), top + row * layout.row_height, edge(cell + 1) - edge(cell),
                       layout.row_height, 0, {{1, 1, 1}, 1});
  }
}

std::optional<FrameCode> ReadFrameCode(const Image& image) {
  if (image.width <= 0 || image.height <= 0) return std::nullopt;
  for (const int shrunk : {1, 2}) {
    if (auto code = ReadAt(image, shrunk)) return code;
  }
  return std::nullopt;
}

}  // namespace kinescope::render
