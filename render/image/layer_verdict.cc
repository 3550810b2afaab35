// What the layers of a difference found, in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/image/picture_difference.h"

namespace kinescope::render {
namespace {

std::string TextOf(const Tile& box) {
  return fmt::format("{}x{} px at x {}, y {}", box.width, box.height, box.x, box.y);
}

LayerVerdict JudgeSize(const PictureDifference& difference) {
  return {"size", difference.is_same_size,
          difference.is_same_size
              ? fmt::format("{}x{} px", difference.actual_width, difference.actual_height)
              : fmt::format("expected {}x{} px, found {}x{} px", difference.expected_width,
                            difference.expected_height, difference.actual_width,
                            difference.actual_height)};
}

LayerVerdict JudgePixels(const PictureDifference& difference) {
  const PixelLayer& pixels = difference.pixels;
  const DifferenceLimits& limits = difference.limits;
  const double all = static_cast<double>(difference.actual_width) * difference.actual_height;
  const double share = 100 * static_cast<double>(pixels.changed) / all;
  std::string text =
      fmt::format("{} beyond {} of colour distance ({} %, limit {}), largest distance {:.2f}",
                  pixels.changed, limits.color_distance,
                  share < 10 ? fmt::format("{:.2g}", share) : fmt::format("{:.0f}", share),
                  limits.changed_pixels, pixels.largest_distance);
  if (pixels.on_edges > 0) text += fmt::format(", {} more on smoothed edges", pixels.on_edges);
  if (!pixels.clusters.empty()) {
    const Cluster& largest = pixels.clusters.front();
    text += fmt::format(", largest cluster {} ({} pixels)", TextOf(largest.box), largest.pixels);
  }
  return {"pixels", pixels.changed <= limits.changed_pixels, text};
}

LayerVerdict JudgeStructure(const PictureDifference& difference) {
  const Structure& structure = difference.structure;
  std::string text =
      fmt::format("worst block {:.3f} (limit {})", structure.worst, difference.limits.structure);
  if (!IsEmpty(structure.worst_block)) text += ": " + TextOf(structure.worst_block);
  text += fmt::format(", mean {:.4f}", structure.mean);
  return {"structure", structure.worst >= difference.limits.structure, text};
}

// "2.4 levels darker", or the channels where they differ in direction.
std::string TextOf(const ToneLight& light) {
  const auto [least, most] = std::minmax_element(light.difference.begin(), light.difference.end());
  if (*most <= 0) return fmt::format("{:.2f} levels darker", -*least);
  if (*least >= 0) return fmt::format("{:.2f} levels brighter", *most);
  return fmt::format("red {:+.2f}, green {:+.2f}, blue {:+.2f} levels", light.difference[0],
                     light.difference[1], light.difference[2]);
}

LayerVerdict JudgeLight(const PictureDifference& difference) {
  if (!difference.light.is_known) {
    return {"light", true, "not known: the pixels that agree in colour are too few"};
  }
  const ToneLight& worst = difference.light.worst;
  const double limit = difference.limits.light;
  if (worst.largest() < 0.005) {
    return {"light", true, fmt::format("less than 0.01 levels off (limit {})", limit)};
  }
  return {"light", worst.largest() <= limit,
          fmt::format("{} where luma is {} to {} (limit {})", TextOf(worst), worst.least_luma,
                      worst.most_luma, limit)};
}

}  // namespace

std::vector<LayerVerdict> JudgeLayers(const PictureDifference& difference) {
  if (!difference.is_same_size) return {JudgeSize(difference)};
  return {JudgeSize(difference), JudgePixels(difference), JudgeStructure(difference),
          JudgeLight(difference)};
}

bool IsSameToTheEye(const PictureDifference& difference) {
  const std::vector<LayerVerdict> layers = JudgeLayers(difference);
  return std::all_of(layers.begin(), layers.end(),
                     [](const LayerVerdict& layer) { return layer.passes; });
}

}  // namespace kinescope::render
