#include "server/picture/pinhole.h"

#include <Eigen/Geometry>
#include <cmath>

namespace kinescope::app {

Pinhole PinholeOf(const render::Camera& camera, int height_px) {
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  const Eigen::Vector3d right = forward.cross(camera.up).normalized();
  Eigen::Matrix3d axes;
  axes << right, forward.cross(right), forward;
  Pinhole pinhole;
  pinhole.world_from_optical.position = camera.position;
  pinhole.world_from_optical.orientation = Eigen::Quaterniond(axes).normalized();
  pinhole.focal_px = 0.5 * height_px / std::tan(0.5 * camera.vertical_fov_rad);
  return pinhole;
}

}  // namespace kinescope::app
