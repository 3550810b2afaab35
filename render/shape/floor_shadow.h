/// The soft shadow of a person on the floor, where their limbs hide it from the sky. It is blended
/// into the finished floor: GL would take a fifth of a picture for it, because it has many pixels,
/// each of which it would read, blend and write several times. One thread.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/palette.h"
#include "render/camera/camera.h"
#include "render/image/image.h"
#include "render/image/tile.h"
#include "urdf/skin/occlusion.h"

namespace kinescope::render {

class FloorShadow {
 public:
  FloorShadow();

  /// Of `limbs`, world, m.
  void Cast(const skin::Capsules& limbs);

  /// Colours `within` of `image`, which `camera` sees, rather like `color` the darker the shadow
  /// is. The same pixels change in the same way whatever else is within.
  void BlendInto(Image& image, const Tile& within, const Camera& camera, const Rgb& color) const;

  static constexpr int kRun = 16;  // px, computed from one start; runs begin at multiples of it

 private:
  using Shades = std::array<float, kRun>;
  void FindShade();
  Shades ShadesOf(const Eigen::Vector3f& start, const Eigen::Vector3f& along) const;

  static constexpr int kSide = 30;  // points

  std::vector<Eigen::Vector3f> points_;             // (kSide, kSide), world, m
  Eigen::Vector2f first_ = {0, 0}, step_ = {1, 1};  // m, of the points
  std::vector<float> shade_;                        // at each point, 0 to 1
  // Columns and rows beyond which there is no shade.
  std::array<int, 2> least_ = {0, 0}, most_ = {0, 0};
};

}  // namespace kinescope::render
