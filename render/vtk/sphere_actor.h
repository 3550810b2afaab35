/// Renders up to 16 spheres in one draw call. Each is a dome that faces the camera: round at any
/// size with few triangles, and its rim is a ring in the picture from every side.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "core/palette.h"
#include "render/camera/camera.h"
#include "render/camera/picture_region.h"
#include "render/vtk/shaded_actor.h"

namespace kinescope::render {

inline constexpr int kSphereCapacity = 16;

struct SphereLook {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // world, m
  double radius = 0;                                 // m; 0 hides it
  double depth = 0;  // m, by which it counts as nearer than its centre when it meets body and other
                     // spheres: it is in front as a whole, or shines through
  Rgb color = {0, 0, 0};
  double rim = 0;  // weight of the outer ring: 0..1 dark, 0..-1 white
};

class SphereActor {
 public:
  SphereActor(Pass pass, double opacity);

  /// Shows these spheres and hides the others. `is_small`: discs will do, because no radius is
  /// more than kSmallRadius pixels.
  void Show(const std::vector<SphereLook>& spheres, const Camera& camera, bool is_small);
  static constexpr double kSmallRadius = 30;

  /// Of the spheres of the newest Show.
  void AddTo(PictureRegion& region) const;
  std::array<vtkActor*, 2> actors() { return {fine_.actor(), coarse_.actor()}; }

 private:
  Pass pass_;
  ShadedActor fine_, coarse_;               // one of them is drawn
  std::vector<Eigen::AlignedBox3f> boxes_;  // around the spheres, world
};

}  // namespace kinescope::render
