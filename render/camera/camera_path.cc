#include "render/camera/camera_path.h"

#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

double Mix(double a, double b, double t) { return (1 - t) * a + t * b; }

// Also where a quantity is a scale: evenly in its ratio.
double MixScale(double a, double b, double t) { return a * std::pow(b / a, t); }

struct Bearing {
  double azimuth, elevation;  // rad, of the camera seen from its target
};
Bearing BearingOf(const Eigen::Vector3d& to_camera) {
  return {std::atan2(to_camera.y(), to_camera.x()),
          std::atan2(to_camera.z(), std::hypot(to_camera.x(), to_camera.y()))};
}

// So that a level horizon stays level on the way, which a turn by the shortest way would tilt.
bool IsLevel(const Camera& camera) {
  const Eigen::Vector3d to_camera = camera.position - camera.target;
  return camera.up.normalized().z() > 1 - 1e-9 &&
         std::hypot(to_camera.x(), to_camera.y()) > 1e-3 * to_camera.norm();
}

Eigen::Quaterniond OrientationOf(const Camera& camera) {
  const glm::dmat4 view = ViewFromWorld(camera);
  Eigen::Matrix3d view_from_world;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) view_from_world(row, column) = view[column][row];
  }
  return Eigen::Quaterniond(view_from_world.transpose());
}

// From rest to rest: first and second derivative vanish at both ends.
double Smooth(double t) { return t * t * t * (10 + t * (6 * t - 15)); }

}  // namespace

Camera Between(const Camera& from, const Camera& to, double t) {
  if (t <= 0) return from;
  if (t >= 1) return to;
  Camera camera = from;
  camera.target = (1 - t) * from.target + t * to.target;
  const Eigen::Vector3d a = from.position - from.target, b = to.position - to.target;
  camera.vertical_fov_rad = Mix(from.vertical_fov_rad, to.vertical_fov_rad, t);
  const auto slope = [](const Camera& of) { return std::tan(0.5 * of.vertical_fov_rad); };
  // By the heights that are shown: what is at the target does not shrink while the lens changes.
  const double distance = MixScale(slope(from) * a.norm(), slope(to) * b.norm(), t) / slope(camera);
  if (IsLevel(from) && IsLevel(to)) {
    const Bearing first = BearingOf(a), last = BearingOf(b);
    const double turn = std::remainder(last.azimuth - first.azimuth, 2 * M_PI);  // the shorter way
    const double azimuth = first.azimuth + t * turn;
    const double elevation = Mix(first.elevation, last.elevation, t);
    const Eigen::Vector3d to_camera(std::cos(elevation) * std::cos(azimuth),
                                    std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    camera.position = camera.target + distance * to_camera;
  } else {
    const Eigen::Quaterniond turned = OrientationOf(from).slerp(t, OrientationOf(to));
    camera.position = camera.target + distance * (turned * Eigen::Vector3d::UnitZ());
    camera.up = turned * Eigen::Vector3d::UnitY();
  }
  camera.near_m = std::min(from.near_m, to.near_m);
  camera.far_m = std::max(from.far_m, to.far_m);
  if (from.is_orthographic() && to.is_orthographic()) {
    camera.ortho_height_m = MixScale(from.ortho_height_m, to.ortho_height_m, t);
  }
  return camera;
}

Camera AlongPath(const std::vector<CameraKey>& keys, double secs) {
  KINESCOPE_CHECK(!keys.empty());
  const auto next = std::upper_bound(keys.begin(), keys.end(), secs,
                                     [](double at, const CameraKey& key) { return at < key.secs; });
  if (next == keys.begin()) return keys.front().camera;
  const CameraKey& last = *std::prev(next);
  if (next == keys.end() || last.ease == Ease::kHold) return last.camera;
  const double t = (secs - last.secs) / (next->secs - last.secs);
  return Between(last.camera, next->camera, last.ease == Ease::kSmooth ? Smooth(t) : t);
}

}  // namespace kinescope::render
