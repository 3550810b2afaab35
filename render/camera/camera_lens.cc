// Cameras made from cameras: other lenses, other shapes of picture.
#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "render/camera/camera.h"

namespace kinescope::render {
namespace {

Camera AtDistance(Camera camera, double distance) {
  const Eigen::Vector3d to_camera = (camera.position - camera.target).normalized();
  camera.position = camera.target + distance * to_camera;
  camera.near_m = std::min(camera.near_m, 0.02 * distance);
  camera.far_m = std::max(camera.far_m, 4 * distance);
  return camera;
}

}  // namespace

double ShownHeight(const Camera& camera) {
  if (camera.is_orthographic()) return camera.ortho_height_m;
  return 2 * std::tan(0.5 * camera.vertical_fov_rad) * (camera.position - camera.target).norm();
}

Camera WithFov(const Camera& camera, double vertical_fov_rad) {
  KINESCOPE_CHECK(vertical_fov_rad > 0 && vertical_fov_rad < M_PI);
  Camera other = camera;
  other.vertical_fov_rad = vertical_fov_rad;
  other.ortho_height_m = 0;
  return AtDistance(other, 0.5 * ShownHeight(camera) / std::tan(0.5 * vertical_fov_rad));
}

Camera Orthographic(const Camera& camera) {
  Camera other = camera;
  other.ortho_height_m = ShownHeight(camera);
  // Nothing between the eye and the target is to be cut off, however wide the view.
  return AtDistance(other,
                    std::max((camera.position - camera.target).norm(), 2 * other.ortho_height_m));
}

namespace {

// `camera` that shows `factor` times as much; as it is below 1.
Camera Widened(const Camera& camera, double factor) {
  if (factor <= 1) return camera;
  Camera wider = camera;
  if (camera.is_orthographic()) {
    wider.ortho_height_m *= factor;
    return wider;
  }
  return AtDistance(wider, factor * (camera.position - camera.target).norm());
}

}  // namespace

Camera ForAspect(const Camera& camera, double aspect) {
  return Widened(camera, kGroupFraming.min_width_m / (ShownHeight(camera) * aspect));
}

Camera WithWholeExtent(const Camera& camera, double aspect) { return Widened(camera, 1 / aspect); }

Camera Turned(const Camera& camera, double angle_rad) {
  const Eigen::AngleAxisd turn(angle_rad, Eigen::Vector3d::UnitZ());
  Camera turned = camera;
  turned.position = camera.target + turn * (camera.position - camera.target);
  turned.up = turn * camera.up;
  return turned;
}

}  // namespace kinescope::render
