/// Cameras by name, and where a point of the world lands in the picture. The same name gives the
/// same view in picture, page and RViz. World: z up, metres. GLM does the matrices; it does not
/// show here.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::render {

struct Camera {
  Eigen::Vector3d position = {3, 3, 1.6};
  Eigen::Vector3d target = {0, 0, 0.95};
  Eigen::Vector3d up = {0, 0, 1};
  double vertical_fov_rad = 0.52;  // 30 deg
  double near_m = 0.05;
  double far_m = 60;
  /// Above 0 the picture is orthographic and this high, m, at any depth; the field of view then
  /// counts for nothing.
  double ortho_height_m = 0;

  bool is_orthographic() const { return ortho_height_m > 0; }
};

/// "front", "back", "left", "right", "top", "iso", "three_quarter": the order shown to people.
const std::vector<std::string>& CameraNames();

/// The named camera, aimed at the people in `state` (their pelvis on the ground plane; the origin
/// when nobody is there) at the distance that shows a standing adult with arms overhead.
/// With nobody but robots: aimed at the middle of these, at the distance that shows all of them.
/// front: seen from +x, so that the person looks at the camera.
/// @throws UsageError naming the camera asked for and those that exist.
Camera NamedCamera(const std::string& name, const SceneState& state);

/// What named cameras are aimed at: the people's middle on the floor, and how far the outermost
/// stands from it, m.
struct Whereabouts {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // world, m
  double radius = 0;                                 // m
};
Whereabouts WhereaboutsOf(const SceneState& state);

/// The named camera aimed at `about`, as if people stood there. @throws as NamedCamera.
Camera NamedCameraAt(const std::string& name, const Whereabouts& about);

/// Height of what `camera` shows at its target's depth, m.
double ShownHeight(const Camera& camera);

/// `camera` moved along its axis so that with another field of view, or with none, what lies at the
/// target's depth keeps its size. @pre 0 < fov < pi
[[nodiscard]] Camera WithFov(const Camera& camera, double vertical_fov_rad);
[[nodiscard]] Camera Orthographic(const Camera& camera);

/// `camera` moved back where a narrow picture (width / height = `aspect`) would cut off the arms of
/// the person in its middle; web/cameras.js does the same.
[[nodiscard]] Camera ForAspect(const Camera& camera, double aspect);

/// Turned about the vertical through its target, counter-clockwise seen from above.
[[nodiscard]] Camera Turned(const Camera& camera, double angle_rad);

/// Around all that is drawn of people, objects and robots, world, m; empty where nobody is.
Eigen::AlignedBox3d BoxOf(const SceneState& state);

/// `camera` moved, without being turned, so that `box` just fits into its picture with a margin.
/// @pre !box.isEmpty()
[[nodiscard]] Camera Framing(const Camera& camera, const Eigen::AlignedBox3d& box, double aspect);

/// Whereabouts that do not sway with the people: they stand still while they stay near the middle
/// of the picture, and are drawn along, without jumps, when they walk away. A floor that stands
/// still is easier on the eye and far cheaper to draw and to encode. One sequence of states gives
/// one sequence of whereabouts. One thread.
class SteadyWhereabouts {
 public:
  /// Call once per picture. The first people to come are met at once; with nobody there, it waits.
  const Whereabouts& Follow(const SceneState& state);

 private:
  bool has_met_ = false;
  Whereabouts about_;  // radius: of the group it has room for
};

struct Projected {
  double x_px = 0;      // from the left edge
  double y_px = 0;      // from the top edge
  double depth_m = 0;   // along the view axis; <= 0: behind the camera (perspective)
  double px_per_m = 0;  // size there of a metre that faces the camera
};

Projected Project(const Eigen::Vector3d& point_in_world, const Camera& camera, int width_px,
                  int height_px);

}  // namespace kinescope::render
