/// A size that follows what is needed without changing for each tile or view of a picture: textures
/// of that size are costly to make.
#pragma once

#include <algorithm>

namespace kinescope::render {

class HeldSize {
 public:
  /// Sizes that are larger than all that was needed this many times become smaller.
  static constexpr int kLongest = 64;

  /// From now on the size is at least `width` x `height`.
  void Need(int width, int height) {
    needed_width_ = std::max(needed_width_, width);
    needed_height_ = std::max(needed_height_, height);
    width_ = std::max(width_, width);
    height_ = std::max(height_, height);
    if (++times_ < kLongest) return;
    width_ = needed_width_;
    height_ = needed_height_;
    times_ = needed_width_ = needed_height_ = 0;
  }

  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int width_ = 0, height_ = 0;
  int needed_width_ = 0, needed_height_ = 0, times_ = 0;  // since it became smaller
};

}  // namespace kinescope::render
