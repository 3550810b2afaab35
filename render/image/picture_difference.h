/// How two pictures differ, in layers that detect different things: levels, pixels, structure and
/// light. None of them is enough: a picture that is 1 % darker passes all but the last, exchanged
/// colours of equal grey all but the second. Pure functions, any thread.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/image/clusters.h"
#include "render/image/compare.h"
#include "render/image/image.h"
#include "render/image/structure.h"

namespace kinescope::render {

/// The pictures are the same to the eye where each layer keeps its limit.
struct DifferenceLimits {
  /// From here on a pixel is changed (render/image/color_distance.h, 0 to 1): 13 levels of grey.
  double color_distance = 0.05;
  /// Most pixels that are changed and not on smoothed edges.
  std::int64_t changed_pixels = 0;
  /// Least similarity of a block.
  double structure = 0.975;
  /// Most difference in light, levels. More than 1, so that each level may be rounded otherwise.
  double light = 1.05;
};

enum class PixelMark : std::uint8_t {
  kSame,    // or below the limit
  kEdge,    // changed, on a smoothed edge
  kSlight,  // changed: distance up to 0.1
  kClear,   // up to 0.2
  kStrong,  // up to 0.4
  kTotal,   // above
};

/// Colour of pixels one by one.
struct PixelLayer {
  std::int64_t changed = 0;       // beyond the limit, but for those on smoothed edges
  std::int64_t on_edges = 0;      // beyond the limit, on smoothed edges
  double largest_distance = 0;    // of all pixels, 0 to 1
  std::vector<Cluster> clusters;  // of changed pixels, the largest first
  std::vector<PixelMark> marks;   // (height, width); empty if no pixel is marked
};

/// Light of a part of the tones: the pixels whose luma in the expected picture is in a range, and
/// which are not changed.
struct ToneLight {
  int least_luma = 0, most_luma = 0;   // levels
  std::array<double, 3> difference{};  // mean of actual - expected, levels of red, green, blue
  double largest() const;              // magnitude
};

/// Mean differences that no single pixel shows. Only tones of 1 % of the picture or more count.
struct LightLayer {
  bool is_known = false;  // whether any tone counts
  ToneLight worst;        // the tone that differs most
};

struct PictureDifference {
  int expected_width = 0, expected_height = 0, actual_width = 0, actual_height = 0;  // px
  bool is_same_size = true;   // if not, there is no other layer
  bool is_byte_equal = true;  // each pixel, also where it is invisible
  DifferenceLimits limits;
  Comparison levels;  // informs only
  PixelLayer pixels;
  Structure structure;
  LightLayer light;
};

/// Transparent pictures are compared on white and on black; the larger distance counts, and
/// structure and light are those on white.
PictureDifference FindDifference(const Image& expected, const Image& actual,
                                 const DifferenceLimits& limits = {});

/// What one layer found.
struct LayerVerdict {
  std::string layer;  // "size", "pixels", "structure" or "light"
  bool passes = true;
  std::string text;  // found value and limit, without the name of the layer
};

/// In the order in which they are told; only "size" if the sizes differ.
std::vector<LayerVerdict> JudgeLayers(const PictureDifference& difference);

/// Whether all layers pass.
bool IsSameToTheEye(const PictureDifference& difference);

}  // namespace kinescope::render
