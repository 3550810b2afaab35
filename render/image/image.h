/// A picture in memory: RGBA, 8 bits per channel, row-major, top row first, no padding. Plain data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "render/image/cell_set.h"

namespace kinescope::render {

/// The pixels of a picture or of a part of it, as `Image::rgba` has them, which several share.
using SharedPixels = std::shared_ptr<const std::vector<std::uint8_t>>;

struct Image {
  int width = 0;                   // px
  int height = 0;                  // px
  std::vector<std::uint8_t> rgba;  // (height, width, 4)
  /// Whether every pixel is known to be opaque. Set by the function that draws it, so that writers
  /// of files need not search.
  bool is_opaque = false;

  /// The pixels, as `rgba` has them, that this picture has but in the squares of `changed`; null
  /// where that is not known. Pictures with one floor differ in no other squares, so that the
  /// others need be neither copied nor encoded again. What draws on a picture calls MarkChanged(),
  /// or sets `floor` to null.
  SharedPixels floor = nullptr;
  CellSet changed = {};
};

/// Pixels of `tile` are no longer those of the floor.
inline void MarkChanged(Image& image, const Tile& tile) {
  if (image.floor != nullptr) image.changed.Add(tile);
}

/// Whether every pixel is opaque: searches `image` if that is not known.
inline bool IsOpaque(const Image& image) {
  if (image.is_opaque) return true;
  // Without a way out in the middle the compiler looks at many pixels at a time.
  std::uint8_t all = 255;
  for (std::size_t at = 3; at < image.rgba.size(); at += 4) all &= image.rgba[at];
  return all == 255;
}

/// Sets the size and reuses the memory. The caller must write all pixels afterwards.
inline void SetSize(Image& image, int width, int height) {
  if (image.width != width || image.height != height) image.floor = nullptr;
  image.width = width;
  image.height = height;
  image.is_opaque = false;
  image.rgba.resize(4 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
}

}  // namespace kinescope::render
