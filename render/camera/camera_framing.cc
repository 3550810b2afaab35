// Cameras made from cameras: other lenses, other shapes of picture, other things to be in it.
#include <algorithm>
#include <cmath>

#include "core/system/check.h"
#include "render/camera/camera.h"
#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

// How far a limb reaches beyond the joint that it is known by: half a head, a hand, a foot.
constexpr double kFlesh = 0.16;  // m

constexpr double kMargin = 1.06;  // of the picture's half width, left free around a framed box

Camera AtDistance(Camera camera, double distance) {
  const Eigen::Vector3d to_camera = (camera.position - camera.target).normalized();
  camera.position = camera.target + distance * to_camera;
  camera.near_m = std::min(camera.near_m, 0.02 * distance);
  camera.far_m = std::max(camera.far_m, 4 * distance);
  return camera;
}

// Axes of the camera: right, up, forward; rows of view_from_world.
Eigen::Matrix3d AxesOf(const Camera& camera) {
  const glm::dmat4 view = ViewFromWorld(camera);
  Eigen::Matrix3d axes;
  for (int axis = 0; axis < 3; ++axis) {
    axes(0, axis) = view[axis][0];
    axes(1, axis) = view[axis][1];
    axes(2, axis) = -view[axis][2];
  }
  return axes;
}

// The place on one side's axis, and the depth along the view axis, of an eye that sees all points
// within +-slope; x and z are of the points in the camera's axes.
struct Seat {
  double side, depth;
};
Seat SeatOf(const Eigen::Matrix<double, 3, 8>& points, int axis, double slope) {
  const auto side = points.row(axis).array(), depth = points.row(2).array();
  const double right = (side - slope * depth).maxCoeff();
  const double left = (-side - slope * depth).maxCoeff();
  return {(right - left) / 2, -(right + left) / (2 * slope)};
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

Camera ForAspect(const Camera& camera, double aspect) {
  const double widened = kGroupFraming.min_width_m / (ShownHeight(camera) * aspect);
  if (widened <= 1) return camera;
  Camera wider = camera;
  if (camera.is_orthographic()) {
    wider.ortho_height_m *= widened;
    return wider;
  }
  return AtDistance(wider, widened * (camera.position - camera.target).norm());
}

Camera Turned(const Camera& camera, double angle_rad) {
  const Eigen::AngleAxisd turn(angle_rad, Eigen::Vector3d::UnitZ());
  Camera turned = camera;
  turned.position = camera.target + turn * (camera.position - camera.target);
  turned.up = turn * camera.up;
  return turned;
}

Eigen::AlignedBox3d BoxOf(const SceneState& state) {
  Eigen::AlignedBox3d box;
  const Eigen::Vector3d flesh = Eigen::Vector3d::Constant(kFlesh);
  const auto add = [&](const Eigen::Vector3d& point) {
    if (!point.allFinite()) return;
    box.extend(Eigen::Vector3d(point - flesh));
    box.extend(Eigen::Vector3d(point + flesh));
  };
  for (const PersonState& person : state.people) {
    for (const urdf::Pose& link : person.links) add(link.position);
    for (const auto& prop : person.props) {
      if (prop) add(prop->pose.position);
    }
  }
  for (const TrackedObject& object : state.objects) add(object.pose.position);
  // Soles are on the floor, not a hand's breadth below.
  if (!box.isEmpty() && box.min().z() < state.floor_z && box.max().z() > state.floor_z) {
    box.min().z() = std::max(box.min().z(), state.floor_z - 0.02);
  }
  for (const RobotState& robot : state.robots) {
    if (!robot.bounds.isEmpty()) {
      box.extend(robot.bounds);
    } else {
      for (const Eigen::Isometry3d& link : robot.world_from_link) box.extend(link.translation());
    }
  }
  return box;
}

Camera Framing(const Camera& camera, const Eigen::AlignedBox3d& box, double aspect) {
  KINESCOPE_CHECK(!box.isEmpty() && aspect > 0);
  const Eigen::Matrix3d axes = AxesOf(camera);
  Eigen::Matrix<double, 3, 8> points;
  for (int i = 0; i < 8; ++i) {
    points.col(i) = axes * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  }
  const Eigen::Vector3d center = axes * box.center();
  Camera framed = camera;
  Eigen::Vector3d eye = center;  // in the camera's axes
  if (camera.is_orthographic()) {
    const Eigen::Vector3d extent = points.rowwise().maxCoeff() - points.rowwise().minCoeff();
    framed.ortho_height_m = kMargin * std::max({extent.y(), extent.x() / aspect, 0.02});
    eye.z() -= std::max(2 * framed.ortho_height_m, extent.z());
  } else {
    const double slope = std::tan(0.5 * camera.vertical_fov_rad) / kMargin;
    const Seat across = SeatOf(points, 0, slope * aspect), upright = SeatOf(points, 1, slope);
    eye = {across.side, upright.side, std::min(across.depth, upright.depth)};
  }
  const double distance = std::max(center.z() - eye.z(), 0.02);
  framed.position = axes.transpose() * eye;
  framed.target = framed.position + distance * axes.row(2).transpose();
  framed.near_m = std::min(camera.near_m, 0.02 * distance);
  framed.far_m = std::max(camera.far_m, 4 * distance);
  return framed;
}

}  // namespace kinescope::render
