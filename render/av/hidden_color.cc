#include "render/av/hidden_color.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace kinescope::render::av {
namespace {

using Color = std::array<std::uint8_t, 3>;

class ColorSum {
 public:
  void Add(const std::uint8_t* color, unsigned weight) {
    weight_ += weight;
    for (std::size_t i = 0; i < 3; ++i) sums_[i] += weight * color[i];
  }
  bool empty() const { return weight_ == 0; }
  Color mean() const {
    Color mean{};
    for (std::size_t i = 0; i < 3; ++i) {
      mean[i] = static_cast<std::uint8_t>((sums_[i] + weight_ / 2) / weight_);
    }
    return mean;
  }

 private:
  unsigned weight_ = 0;
  std::array<unsigned, 3> sums_{};
};

// The picture in blocks of two by two pixels.
class Blocks {
 public:
  explicit Blocks(Image& image)
      : image_(image),
        columns_(image.width / 2),
        rows_(image.height / 2),
        colors_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)),
        known_(colors_.size()) {}

  void FindVisible() {
    ForEach([&](int x, int y) {
      ColorSum sum;
      for (const std::uint8_t* pixel : PixelsOf(x, y)) sum.Add(pixel, pixel[3]);
      Set(x, y, sum);
    });
  }

  // One ring of blocks around those that are known.
  void Spread() {
    const std::vector<std::uint8_t> before = known_;
    ForEach([&](int x, int y) {
      if (before[At(x, y)] != 0) return;
      ColorSum sum;
      for (int row = std::max(y - 1, 0); row <= std::min(y + 1, rows_ - 1); ++row) {
        for (int column = std::max(x - 1, 0); column <= std::min(x + 1, columns_ - 1); ++column) {
          if (before[At(column, row)] != 0) sum.Add(colors_[At(column, row)].data(), 1);
        }
      }
      Set(x, y, sum);
    });
  }

  void Paint() {
    Color color = {128, 128, 128};  // until one is known
    ForEach([&](int x, int y) {
      if (known_[At(x, y)] != 0) color = colors_[At(x, y)];
      for (std::uint8_t* pixel : PixelsOf(x, y)) {
        if (pixel[3] == 0) std::copy(color.begin(), color.end(), pixel);
      }
    });
  }

 private:
  std::size_t At(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }

  std::array<std::uint8_t*, 4> PixelsOf(int x, int y) {
    const std::size_t stride = 4 * static_cast<std::size_t>(image_.width);
    std::uint8_t* first = image_.rgba.data() + 2 * static_cast<std::size_t>(y) * stride +
                          8 * static_cast<std::size_t>(x);
    return {first, first + 4, first + stride, first + stride + 4};
  }

  void Set(int x, int y, const ColorSum& sum) {
    if (sum.empty()) return;
    colors_[At(x, y)] = sum.mean();
    known_[At(x, y)] = 1;
  }

  template <class Visit>
  void ForEach(Visit&& visit) {
    for (int y = 0; y < rows_; ++y) {
      for (int x = 0; x < columns_; ++x) visit(x, y);
    }
  }

  Image& image_;
  const int columns_, rows_;
  std::vector<Color> colors_;
  std::vector<std::uint8_t> known_;
};

}  // namespace

void HideColors(Image& image) {
  Blocks blocks(image);
  blocks.FindVisible();
  for (int ring = 0; ring < 2; ++ring) blocks.Spread();  // as far as chroma is interpolated
  blocks.Paint();
}

}  // namespace kinescope::render::av
