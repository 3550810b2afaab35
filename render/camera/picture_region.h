/// The part of a picture that may differ from its floor. Actors add where they may be; what they
/// do not cover need not be drawn. Always too large rather than too small. One thread.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat4x4.hpp>
#include <vector>

#include "render/camera/camera.h"
#include "render/image/cell_set.h"

namespace kinescope::render {

class PictureRegion {
 public:
  /// Nothing of a picture of `width` x `height` px that `camera` sees. `margin`: px, around all
  /// that is added, because positions are rounded to floats here and, in another order, by GL.
  PictureRegion(const Camera& camera, int width, int height, double margin);

  void AddEverything();
  /// A box in the world, or in the frame that `world_from_box` places there, and `around_px` on
  /// each side of it.
  void AddBox(const Eigen::AlignedBox3f& box,
              const Eigen::Matrix4f& world_from_box = Eigen::Matrix4f::Identity(),
              float around_px = 0);
  /// Triangles between `positions` (world, m): three indices each, which are valid.
  template <class Index>
  void AddTriangles(const std::vector<Eigen::Vector3f>& positions,
                    const std::vector<std::array<Index, 3>>& triangles) {
    if (!FindAll(positions)) return;
    for (const auto& triangle : triangles) AddTriangle(triangle[0], triangle[1], triangle[2]);
  }
  void AddTriangles(const std::vector<Eigen::Vector3f>& positions,
                    const std::vector<std::uint32_t>& corners);

  bool is_everything() const { return is_everything_; }
  /// Covers the region; no two of them overlap.
  std::vector<Tile> Rectangles() const { return cells_.Rectangles(); }

 private:
  // px, from the upper left corner.
  struct Place {
    float x = 0, y = 0;
  };
  // nullopt: behind the camera, or at no place.
  bool Find(const Eigen::Vector4f& clip, Place& place) const;
  // false: the region is everything.
  bool FindAll(const std::vector<Eigen::Vector3f>& positions);
  void AddTriangle(std::size_t a, std::size_t b, std::size_t c);
  void AddAround(float left, float top, float right, float bottom);

  int width_, height_;  // px
  float margin_;        // px
  Eigen::Matrix4f clip_from_world_;
  bool is_everything_ = false;
  CellSet cells_;
  std::vector<Place> places_;  // of FindAll
};

}  // namespace kinescope::render
