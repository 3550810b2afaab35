/// Cameras by name, and where a point of the world lands in the picture. The same name gives the
/// same view in picture, page and RViz. World: z up, metres. GLM does the matrices; it does not
/// show here.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "server/core/scene_state.h"

namespace kinescope::render {

struct Camera {
  Eigen::Vector3d position = {3, 3, 1.6};
  Eigen::Vector3d target = {0, 0, 0.95};
  Eigen::Vector3d up = {0, 0, 1};
  double vertical_fov_rad = 0.52;  // 30 deg
  double near_m = 0.05;
  double far_m = 60;
};

/// "front", "back", "left", "right", "top", "iso", "three_quarter": the order shown to people.
const std::vector<std::string>& CameraNames();

/// The named camera, aimed at the people in `state` (their pelvis on the ground plane; the origin
/// when nobody is there) at the distance that shows a standing adult with arms overhead.
/// With nobody but robots: aimed at the middle of these, at the distance that shows all of them.
/// front: seen from +x, so that the person looks at the camera.
/// @throws UsageError naming the camera asked for and those that exist.
Camera NamedCamera(const std::string& name, const SceneState& state);

/// A named camera that does not sway with the person: it stands still while they stay near the
/// middle of the picture, and is drawn along, without jumps, when they walk away. A floor that
/// stands still is easier on the eye and far cheaper to draw and to encode. One sequence of states
/// gives one sequence of cameras.
class SteadyCamera {
 public:
  /// Call once per picture. Another name than before starts afresh; with nobody there, it waits.
  /// @throws UsageError as NamedCamera.
  Camera Aim(const std::string& name, const SceneState& state);

 private:
  std::string name_;                                  // "" before the first
  Eigen::Vector3d ground_ = Eigen::Vector3d::Zero();  // what it is aimed at, on the floor
  double radius_ = 0;                                 // of the group it has room for, m
};

struct Projected {
  double x_px = 0;      // from the left edge
  double y_px = 0;      // from the top edge
  double depth_m = 0;   // along the view axis; <= 0: behind the camera
  double px_per_m = 0;  // size there of a metre that faces the camera
};

Projected Project(const Eigen::Vector3d& point_in_world, const Camera& camera, int width_px,
                  int height_px);

}  // namespace kinescope::render
