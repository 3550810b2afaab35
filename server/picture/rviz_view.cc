#include "server/picture/rviz_view.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "server/options/text.h"
#include "server/picture/rviz_values.h"

namespace kinescope::app::rviz {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using render::Camera;

constexpr double kQuarter = M_PI / 4;  // RViz's field of view, yaw and pitch, rad
constexpr double kMostPitch = M_PI / 2 - 0.001;
constexpr double kMost = 1e6;         // of numbers that RViz does not limit
constexpr double kAboveFocus = 0.2;   // of the distance: how far XYOrbit moves the camera up
constexpr double kOrthoHeight = 100;  // m above the floor; RViz has 500
constexpr double kLeastAhead = 0.1;   // m, from a camera to its target
constexpr double kWidestHalf = 75 * M_PI / 180;  // rad, of the field of view

// Looks from `position` along x of `turn`, its z is up.
Camera LookFrom(const Vector3d& position, const Matrix3d& turn) {
  Camera camera;
  camera.position = position;
  camera.target = position + turn.col(0);
  camera.up = turn.col(2);
  camera.vertical_fov_rad = kQuarter;
  return camera;
}

Camera Orbit(const YAML::Node& view) {
  const bool is_upside_down = BoolOf(view, "Invert Z Axis", false);
  const double sign = is_upside_down ? -1 : 1;
  const double distance = NumberOf(view, "Distance", 10, 0.001, kMost);
  const double yaw = sign * NumberOf(view, "Yaw", kQuarter, -kMost, kMost);
  const double pitch = sign * NumberOf(view, "Pitch", kQuarter, -kMostPitch, kMostPitch);
  Camera camera;
  camera.target = VectorOf(view, "Focal Point");
  camera.position =
      camera.target + distance * Vector3d(std::cos(yaw) * std::cos(pitch),
                                          std::sin(yaw) * std::cos(pitch), std::sin(pitch));
  camera.up = {0, 0, sign};
  camera.vertical_fov_rad = NumberOf(view, "Field of View", kQuarter, 0.001, M_PI / 2);
  return camera;
}

// The point that it turns about is seen below the middle.
Camera OrbitOverFocus(const YAML::Node& view) {
  Camera camera = Orbit(view);
  const Vector3d ahead = camera.target - camera.position;
  const Vector3d up = ahead.cross(camera.up).cross(ahead).normalized();
  const Vector3d shift = kAboveFocus * ahead.norm() * up;
  camera.position += shift;
  camera.target += shift;
  return camera;
}

Matrix3d TurnOf(const YAML::Node& view, double least, double most) {
  const auto angle = [&](const char* name) { return NumberOf(view, name, 0, least, most); };
  return (AngleAxisd(angle("Yaw"), Vector3d::UnitZ()) *
          AngleAxisd(angle("Pitch"), Vector3d::UnitY()) *
          AngleAxisd(angle("Roll"), Vector3d::UnitX()))
      .toRotationMatrix();
}

Camera FirstPerson(const YAML::Node& view) {
  return LookFrom(VectorOf(view, "Position"), TurnOf(view, -M_PI, M_PI));
}

Camera TopDown(const YAML::Node& view, int height_px) {
  const double saved = NumberOf(view, "Scale", 10, -kMost, kMost);
  const double scale = std::max(1e-3, std::abs(saved));
  const double up = saved < 0 ? -1 : 1;  // RViz then turns the picture by half a turn
  const double x = NumberOf(view, "X", 0, -kMost, kMost), y = NumberOf(view, "Y", 0, -kMost, kMost);
  const double angle = NumberOf(view, "Angle", 0, -kMost, kMost);
  Camera camera;
  camera.position = {x, y, kOrthoHeight};
  camera.target = {x, y, 0};
  camera.up = {-up * std::sin(angle), up * std::cos(angle), 0};
  camera.ortho_height_m = height_px / scale;
  return camera;
}

std::string PointText(const Vector3d& p) {
  return fmt::format("{},{},{}", options::NumberText(p.x()), options::NumberText(p.y()),
                     options::NumberText(p.z()));
}

}  // namespace

std::optional<CameraTexts> CameraOptionsOf(const Camera& saved) {
  Camera camera = saved;
  const double half = camera.ortho_height_m / 2;
  const double farthest =
      std::max({camera.position.cwiseAbs().maxCoeff(), camera.target.cwiseAbs().maxCoeff(),
                half / std::tan(kWidestHalf)});
  if (!(farthest <= kFarthestCamera)) return std::nullopt;
  const Vector3d ahead = camera.target - camera.position;  // RViz goes as near as 1 mm
  camera.target = camera.position + std::max(1.0, kLeastAhead / ahead.norm()) * ahead;
  double fov = camera.vertical_fov_rad;
  if (camera.is_orthographic()) {
    // As far away as a field of view from 1° to 150° has this height.
    const double distance = std::clamp((camera.position - camera.target).norm(),
                                       half / std::tan(kWidestHalf), half / std::tan(M_PI / 360));
    camera.position = camera.target - distance * ahead.normalized();
    fov = 2 * std::atan2(half, distance);
  }
  return CameraTexts{
      PointText(camera.position) + ":" + PointText(camera.target) + ":" + PointText(camera.up),
      options::NumberText(std::clamp(fov * 180 / M_PI, 1.0, 150.0)),
      camera.is_orthographic() ? "orthographic" : "perspective"};
}

View ViewOf(const YAML::Node& current, int height_px) {
  const std::string kind = TextOf(current, "Class", "");
  if (kind == "rviz/Orbit") return {Orbit(current), ""};
  if (kind == "rviz/XYOrbit" || kind == "rviz/ThirdPersonFollower") {
    return {OrbitOverFocus(current), ""};
  }
  if (kind == "rviz/FPS" || kind == "rviz/FrameAligned") return {FirstPerson(current), ""};
  if (kind == "rviz/TopDownOrtho") return {TopDown(current, height_px), ""};
  const std::string start = "; drawn from RViz's first place (Orbit, 10 m away)";
  if (kind.empty()) return {Orbit({}), "the current view has no Class" + start};
  return {Orbit({}), "the view '" + kind + "' is not one of RViz's own" + start};
}

}  // namespace kinescope::app::rviz
