#include "render/image/picture_difference.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <future>
#include <optional>

#include "render/image/color_distance.h"
#include "render/image/luma.h"
#include "render/image/smoothed_edge.h"

namespace kinescope::render {
namespace {

constexpr int kTones = 4;  // of 64 levels of luma each
constexpr int kLevelsPerTone = 256 / kTones;
constexpr double kLeastShareOfTone = 0.01;

// Which blocks of kStructureBlock px differ in any byte.
struct ChangedBlocks {
  int columns = 0, rows = 0;
  std::vector<std::uint8_t> is_changed;  // (rows, columns)
};

ChangedBlocks FindChangedBlocks(const Image& expected, const Image& actual) {
  ChangedBlocks blocks{BlocksIn(expected.width), BlocksIn(expected.height), {}};
  blocks.is_changed.resize(static_cast<std::size_t>(blocks.columns) *
                           static_cast<std::size_t>(blocks.rows));
  const std::size_t row_bytes = 4 * static_cast<std::size_t>(expected.width);
  constexpr std::size_t kBlockBytes = 4 * kStructureBlock;
  for (int y = 0; y < expected.height; ++y) {
    const std::size_t begin = static_cast<std::size_t>(y) * row_bytes;
    if (std::memcmp(&expected.rgba[begin], &actual.rgba[begin], row_bytes) == 0) continue;
    std::uint8_t* block =
        &blocks.is_changed[static_cast<std::size_t>(y / kStructureBlock) * blocks.columns];
    for (std::size_t at = 0; at < row_bytes; at += kBlockBytes, ++block) {
      const std::size_t size = std::min(kBlockBytes, row_bytes - at);
      if (*block == 0 &&
          std::memcmp(&expected.rgba[begin + at], &actual.rgba[begin + at], size) != 0) {
        *block = 1;
      }
    }
  }
  return blocks;
}

// Calls `visit(y, from, to)` for the pixels of each row between its outermost changed blocks.
template <class Visit>
void ForEachChangedRow(const ChangedBlocks& blocks, int width, int height, Visit&& visit) {
  for (int row = 0; row < blocks.rows; ++row) {
    const std::uint8_t* const first =
        &blocks
             .is_changed[static_cast<std::size_t>(row) * static_cast<std::size_t>(blocks.columns)];
    int from = 0, to = blocks.columns;
    while (from < to && first[from] == 0) ++from;
    while (from < to && first[to - 1] == 0) --to;
    if (from == to) continue;
    const int bottom = std::min(height, (row + 1) * kStructureBlock);
    for (int y = row * kStructureBlock; y < bottom; ++y) {
      visit(y, from * kStructureBlock, std::min(width, to * kStructureBlock));
    }
  }
}

Image OnBackground(const Image& image, int level) {
  Image opaque = image;
  opaque.is_opaque = true;
  opaque.floor = nullptr;
  for (std::size_t at = 0; at < opaque.rgba.size(); at += 4) {
    const int alpha = opaque.rgba[at + 3];
    for (std::size_t c = at; c < at + 3; ++c) {
      opaque.rgba[c] =
          static_cast<std::uint8_t>((opaque.rgba[c] * alpha + level * (255 - alpha) + 127) / 255);
    }
    opaque.rgba[at + 3] = 255;
  }
  return opaque;
}

// Squared distances of a row of opaque pixels, unscaled.
void FindDistances(const std::uint8_t* expected, const std::uint8_t* actual, int count,
                   float* squared) {
  for (int i = 0; i < count; ++i) {
    squared[i] =
        UnscaledSquaredDistance(static_cast<float>(actual[4 * i] - expected[4 * i]),
                                static_cast<float>(actual[4 * i + 1] - expected[4 * i + 1]),
                                static_cast<float>(actual[4 * i + 2] - expected[4 * i + 2]));
  }
}

// In eight lanes, which the compiler makes vectors of.
float LargestOf(const float* values, int count) {
  std::array<float, 8> lanes{};
  int i = 0;
  for (; i + 8 <= count; i += 8) {
    for (std::size_t lane = 0; lane < 8; ++lane)
      lanes[lane] = std::max(lanes[lane], values[i + lane]);
  }
  for (; i < count; ++i) lanes[0] = std::max(lanes[0], values[i]);
  return *std::max_element(lanes.begin(), lanes.end());
}

const std::uint8_t* PixelOf(const Image& image, int x, int y) {
  return &image.rgba[4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) +
                          static_cast<std::size_t>(x))];
}

PixelMark MarkOf(float unscaled_squared) {
  if (unscaled_squared <= UnscaledSquare(0.1)) return PixelMark::kSlight;
  if (unscaled_squared <= UnscaledSquare(0.2)) return PixelMark::kClear;
  return unscaled_squared <= UnscaledSquare(0.4) ? PixelMark::kStrong : PixelMark::kTotal;
}

// Sums up the differences of the pixels that are not changed, per tone.
class LightSums {
 public:
  void AddRow(const PicturePair& pair, int y, int from, int to, const float* distances,
              float limit) {
    constexpr int kMostPixels = 2048;  // whose sums fit into 20 bits each
    for (int x = from; x < to; x += kMostPixels) {
      AddPart(pair, y, x, std::min(to, x + kMostPixels), distances, limit);
    }
  }

  LightLayer Layer(const PicturePair& pair) const {
    LightLayer layer;
    const std::array<std::int64_t, kTones> all = CountTones(pair.expected_luma);
    const double least = kLeastShareOfTone * pair.expected.width * pair.expected.height;
    for (std::size_t tone = 0; tone < kTones; ++tone) {
      const auto count = static_cast<double>(all[tone] - changed_[tone]);
      if (count < least || count < 1) continue;
      ToneLight light;
      light.least_luma = static_cast<int>(tone) * kLevelsPerTone;
      light.most_luma = light.least_luma + kLevelsPerTone - 1;
      for (std::size_t c = 0; c < 3; ++c) {
        light.difference[c] = static_cast<double>(sums_[tone][c]) / count;
      }
      if (!layer.is_known || light.largest() >= layer.worst.largest()) layer.worst = light;
      layer.is_known = true;
    }
    return layer;
  }

 private:
  // One addition per pixel: the three channels lie side by side in 64 bits, each moved by 255 so
  // that it is not negative.
  void AddPart(const PicturePair& pair, int y, int from, int to, const float* distances,
               float limit) {
    constexpr int kBits = 20, kZero = 255;
    std::array<std::uint64_t, kTones> packed{};
    std::array<int, kTones> counts{}, changed{};
    const std::uint8_t* const luma = pair.expected_luma.Row(y);
    const std::uint8_t* expected = PixelOf(pair.expected, from, y);
    const std::uint8_t* actual = PixelOf(pair.actual, from, y);
    for (int x = from; x < to; ++x, expected += 4, actual += 4) {
      const auto tone = static_cast<std::size_t>(luma[x] / kLevelsPerTone);
      if (distances[x] > limit) {
        ++changed[tone];
        continue;
      }
      const auto difference = [&](int c) {
        return std::uint64_t{actual[c]} + static_cast<unsigned>(kZero) - expected[c];
      };
      packed[tone] += difference(0) | difference(1) << kBits | difference(2) << (2 * kBits);
      ++counts[tone];
    }
    for (std::size_t tone = 0; tone < kTones; ++tone) {
      changed_[tone] += changed[tone];
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint64_t sum = packed[tone] >> (kBits * c) & ((1U << kBits) - 1);
        sums_[tone][c] += static_cast<std::int64_t>(sum) - std::int64_t{kZero} * counts[tone];
      }
    }
  }

  static std::array<std::int64_t, kTones> CountTones(const LumaPlane& plane) {
    std::array<std::int64_t, kTones> counts{};
    for (int y = 0; y < plane.height; ++y) {
      const std::uint8_t* const luma = plane.Row(y);
      std::array<int, kTones> at_least{plane.width};
      for (int x = 0; x < plane.width; ++x) {
        at_least[1] += static_cast<int>(luma[x] >= kLevelsPerTone);
        at_least[2] += static_cast<int>(luma[x] >= 2 * kLevelsPerTone);
        at_least[3] += static_cast<int>(luma[x] >= 3 * kLevelsPerTone);
      }
      for (std::size_t tone = 0; tone < kTones; ++tone) {
        counts[tone] += at_least[tone] - (tone + 1 < kTones ? at_least[tone + 1] : 0);
      }
    }
    return counts;
  }

  std::array<std::int64_t, kTones> changed_{};  // pixels
  std::array<std::array<std::int64_t, 3>, kTones> sums_{};
};

// Goes once through all pixels that may differ, for the layers of pixels and of light.
class PixelPass {
 public:
  PixelPass(const PicturePair& pair, const std::optional<PicturePair>& on_black, double limit)
      : pair_(pair),
        on_black_(on_black),
        limit_(UnscaledSquare(limit)),
        distances_(static_cast<std::size_t>(pair.expected.width)),
        distances_on_black_(on_black ? distances_.size() : 0),
        clusters_(pair.expected.width, pair.expected.height) {}

  void VisitRow(int y, int from, int to) {
    FindRow(pair_, y, from, to, distances_);
    if (on_black_) {
      FindRow(*on_black_, y, from, to, distances_on_black_);
      for (int x = from; x < to; ++x) {
        const auto i = static_cast<std::size_t>(x);
        distances_[i] = std::max(distances_[i], distances_on_black_[i]);
      }
    }
    const float largest = LargestOf(&distances_[static_cast<std::size_t>(from)], to - from);
    largest_ = std::max(largest_, largest);
    if (largest > limit_) {
      for (int x = from; x < to; ++x) {
        const float distance = distances_[static_cast<std::size_t>(x)];
        if (distance > limit_) AddChanged(x, y, distance);
      }
    }
    if (largest > 0) light_.AddRow(pair_, y, from, to, distances_.data(), limit_);
  }

  PixelLayer TakePixels() {
    pixels_.largest_distance = DistanceOf(largest_);
    pixels_.clusters = clusters_.Take();
    return std::move(pixels_);
  }

  LightLayer Light() const { return light_.Layer(pair_); }

 private:
  static void FindRow(const PicturePair& pair, int y, int from, int to,
                      std::vector<float>& distances) {
    FindDistances(PixelOf(pair.expected, from, y), PixelOf(pair.actual, from, y), to - from,
                  &distances[static_cast<std::size_t>(from)]);
  }

  void AddChanged(int x, int y, float distance) {
    if (pixels_.marks.empty()) {
      pixels_.marks.resize(static_cast<std::size_t>(pair_.expected.width) *
                           static_cast<std::size_t>(pair_.expected.height));
    }
    PixelMark& mark = pixels_.marks[static_cast<std::size_t>(y) * pair_.expected.width + x];
    if (IsOnSmoothedEdge(pair_, x, y)) {
      mark = PixelMark::kEdge;
      ++pixels_.on_edges;
      return;
    }
    mark = MarkOf(distance);
    ++pixels_.changed;
    clusters_.Add(x, y);
  }

  PicturePair pair_;
  std::optional<PicturePair> on_black_;
  float limit_;
  float largest_ = 0;
  std::vector<float> distances_, distances_on_black_;  // of a row
  PixelLayer pixels_;
  ClusterFinder clusters_;
  LightSums light_;
};

// The pictures have one size; one at least is transparent if there is a pair on black.
void FindLayers(const PicturePair& pair, const std::optional<PicturePair>& on_black,
                const ChangedBlocks& blocks, PictureDifference& difference) {
  std::future<Structure> structure = std::async(std::launch::async, [&] {
    return CompareStructure(pair.expected_luma, pair.actual_luma, blocks.is_changed);
  });
  PixelPass pass(pair, on_black, difference.limits.color_distance);
  ForEachChangedRow(blocks, pair.expected.width, pair.expected.height,
                    [&](int y, int from, int to) { pass.VisitRow(y, from, to); });
  difference.light = pass.Light();
  difference.pixels = pass.TakePixels();
  difference.structure = structure.get();
}

// Luma of `image`, which differs in `blocks` only from the picture of `other`.
LumaPlane LumaBeside(const LumaPlane& other, const Image& image, const ChangedBlocks& blocks) {
  LumaPlane luma = other;
  ForEachChangedRow(blocks, image.width, image.height,
                    [&](int y, int from, int to) { luma.TakeRow(image, y, from, to); });
  luma.FillMargin();
  return luma;
}

}  // namespace

double ToneLight::largest() const {
  return std::max({std::abs(difference[0]), std::abs(difference[1]), std::abs(difference[2])});
}

PictureDifference FindDifference(const Image& expected, const Image& actual,
                                 const DifferenceLimits& limits) {
  PictureDifference difference;
  difference.expected_width = expected.width;
  difference.expected_height = expected.height;
  difference.actual_width = actual.width;
  difference.actual_height = actual.height;
  difference.limits = limits;
  difference.levels = Compare(expected, actual);
  difference.is_same_size = difference.levels.same_size;
  difference.is_byte_equal = difference.is_same_size && difference.levels.largest_difference == 0;
  if (!difference.is_same_size || difference.is_byte_equal) return difference;

  const ChangedBlocks blocks = FindChangedBlocks(expected, actual);
  if (IsOpaque(expected) && IsOpaque(actual)) {
    const LumaPlane before(expected), after = LumaBeside(before, actual, blocks);
    FindLayers({expected, actual, before, after}, {}, blocks, difference);
    return difference;
  }
  const Image white_before = OnBackground(expected, 255), white_after = OnBackground(actual, 255);
  const Image black_before = OnBackground(expected, 0), black_after = OnBackground(actual, 0);
  const LumaPlane before(white_before), after = LumaBeside(before, white_after, blocks);
  FindLayers({white_before, white_after, before, after},
             PicturePair{black_before, black_after, before, after}, blocks, difference);
  return difference;
}

}  // namespace kinescope::render
