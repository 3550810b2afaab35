#include "render/camera/camera.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec4.hpp>
#include <map>

#include "core/system/errors.h"
#include "render/camera/camera_matrices.h"

namespace kinescope::render {
namespace {

glm::dvec3 ToGlm(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

// Where everything that one wants to see of a standing adult fits: soles to fingers overhead.
constexpr double kTargetHeight = 1.06;  // m, where GroupFraming::height_m is shown

constexpr double kLeash = 0.35;  // m, that people may go before a steady camera follows
constexpr double kSlack = 0.5;   // m, by which a group may draw together before it comes nearer

struct Direction {
  Eigen::Vector3d to_camera;  // from the target
  Eigen::Vector3d up;
  double vertical_fov_rad = Camera().vertical_fov_rad;
};

// From above the head is much nearer than the feet: with a short lens it would hide the body.
constexpr double kFovFromAbove = 0.2;  // 11 degrees

// Horizontal views look down by a few degrees, so that the floor reads as a floor.
Direction Horizontal(double azimuth_deg, double elevation_deg) {
  const double azimuth = azimuth_deg * M_PI / 180;
  const double elevation = elevation_deg * M_PI / 180;
  return {{std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth),
           std::sin(elevation)},
          Eigen::Vector3d::UnitZ()};
}

const std::vector<std::pair<std::string, Direction>>& Directions() {
  // "left" is the person's left side (+y), as in an anatomical drawing.
  static const std::vector<std::pair<std::string, Direction>> directions = {
      {"front", Horizontal(0, 6)},
      {"back", Horizontal(180, 6)},
      {"left", Horizontal(90, 6)},
      {"right", Horizontal(-90, 6)},
      {"top", {Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX(), kFovFromAbove}},
      {"iso", Horizontal(45, 35.264)},
      {"three_quarter", Horizontal(-38, 14)},
  };
  return directions;
}

}  // namespace

const std::vector<std::string>& CameraNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, direction] : Directions()) all.push_back(name);
    return all;
  }();
  return names;
}

const std::string& CameraMeantBy(const std::string& name) {
  static const std::string right = "right";
  return name == "side" ? right : name;
}

std::vector<const PersonState*> FramedPeople(const SceneState& state) {
  const auto place = [](const PersonState& person) {
    return Eigen::Vector2d(person.links[urdf::kPelvis].position.head<2>());
  };
  const auto nearest = std::min_element(
      state.people.begin(), state.people.end(),
      [&](const auto& a, const auto& b) { return place(a).norm() < place(b).norm(); });
  std::vector<const PersonState*> framed;
  for (const PersonState& person : state.people) {
    if ((place(person) - place(*nearest)).norm() > kGroupFraming.reach_m) continue;
    framed.push_back(&person);
  }
  return framed;
}

GroundExtent GroundExtentOf(const SceneState& state) {
  const std::vector<const PersonState*> people = FramedPeople(state);
  if (people.empty()) return {Eigen::Vector3d(0, 0, state.floor_z), 0};
  const auto place = [&](const PersonState* person) {
    const Eigen::Vector3d& pelvis = person->links[urdf::kPelvis].position;
    return Eigen::Vector3d(pelvis.x(), pelvis.y(), state.floor_z);
  };
  GroundExtent about;
  for (const PersonState* person : people) about.middle += place(person);
  about.middle /= static_cast<double>(people.size());
  for (const PersonState* person : people) {
    about.radius = std::max(about.radius, (place(person) - about.middle).norm());
  }
  return about;
}

Camera NamedCameraAt(const std::string& name, const GroundExtent& about) {
  for (const auto& [known, direction] : Directions()) {
    if (known != CameraMeantBy(name)) continue;
    Camera camera;
    camera.target = about.middle + Eigen::Vector3d(0, 0, kTargetHeight);
    camera.up = direction.up;
    camera.vertical_fov_rad = direction.vertical_fov_rad;
    // Pictures are wider than high, so a group may stand wider than a person is tall; its nearest
    // member comes closer than its middle.
    const double half_width = about.radius + kGroupFraming.margin_m;
    const double half_extent =
        std::max(0.5 * kGroupFraming.height_m, half_width / kGroupFraming.narrowest_aspect);
    const double distance = half_extent / std::tan(0.5 * camera.vertical_fov_rad) + about.radius;
    camera.position = camera.target + distance * direction.to_camera;
    camera.far_m = std::max(camera.far_m, 4 * distance);
    return camera;
  }
  std::string known;
  for (const std::string& each : CameraNames()) known += (known.empty() ? "" : ", ") + each;
  throw UsageError("unknown camera '" + name + "'; expected one of " + known);
}

// Robots and places come in all sizes, so the view is as large as they are.
Camera NamedCameraAround(const std::string& name, const Eigen::AlignedBox3d& extent) {
  constexpr double kMargin = 1.15, kSmallest = 0.02;  // m
  const double radius = std::max(0.5 * extent.diagonal().norm(), kSmallest);
  Camera camera = NamedCameraAt(name, GroundExtent());
  const Eigen::Vector3d to_camera = (camera.position - camera.target).normalized();
  const double distance = kMargin * radius / std::sin(0.5 * camera.vertical_fov_rad);
  camera.target = extent.center();
  camera.position = camera.target + distance * to_camera;
  camera.near_m = std::min(camera.near_m, 0.02 * distance);
  camera.far_m = std::max(camera.far_m, 4 * distance);
  return camera;
}

bool ShowsExtent(const SceneState& state) {
  return state.people.empty() && !state.extent.isEmpty();
}

Camera NamedCamera(const std::string& name, const SceneState& state) {
  if (ShowsExtent(state)) return NamedCameraAround(name, state.extent);
  return NamedCameraAt(name, GroundExtentOf(state));
}

const GroundExtent& SmoothedGroundExtent::Follow(const SceneState& state) {
  const GroundExtent now = GroundExtentOf(state);
  if (!has_people_) {
    has_people_ = !state.people.empty();
    about_ = now;
  } else if (!state.people.empty()) {
    const Eigen::Vector3d away = now.middle - about_.middle;
    const double distance = away.norm();
    if (distance > kLeash) about_.middle += away * (1 - kLeash / distance);
    about_.radius = std::clamp(about_.radius, now.radius, now.radius + kSlack);
  }
  return about_;
}

glm::dmat4 ViewFromWorld(const Camera& camera) {
  const Eigen::Vector3d forward = (camera.target - camera.position).normalized();
  Eigen::Vector3d up = camera.up;
  if (forward.cross(up).norm() < 1e-6 * up.norm()) {
    up = std::abs(forward.x()) < 0.9 ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitY();
  }
  return glm::lookAt(ToGlm(camera.position), ToGlm(camera.target), ToGlm(up));
}

glm::dmat4 ClipFromView(const Camera& camera, double aspect) {
  if (camera.is_orthographic()) {
    const double half = 0.5 * camera.ortho_height_m;
    return glm::ortho(-half * aspect, half * aspect, -half, half, camera.near_m, camera.far_m);
  }
  return glm::perspective(camera.vertical_fov_rad, aspect, camera.near_m, camera.far_m);
}

glm::dmat4 TileFromClip(const Tile& tile, int width_px, int height_px) {
  const double scale_x = static_cast<double>(width_px) / tile.width;
  const double scale_y = static_cast<double>(height_px) / tile.height;
  // Centre of the tile in the whole picture's normalised coordinates; y points up there.
  const double center_x = (2.0 * tile.x + tile.width) / width_px - 1;
  const double center_y = 1 - (2.0 * tile.y + tile.height) / height_px;
  glm::dmat4 matrix(1.0);
  matrix[0][0] = scale_x;
  matrix[1][1] = scale_y;
  matrix[3][0] = -center_x * scale_x;
  matrix[3][1] = -center_y * scale_y;
  return matrix;
}

Projected Project(const Eigen::Vector3d& point_in_world, const Camera& camera, int width_px,
                  int height_px) {
  const glm::dvec4 in_view = ViewFromWorld(camera) * glm::dvec4(ToGlm(point_in_world), 1);
  const double aspect = static_cast<double>(width_px) / height_px;
  Projected projected;
  projected.depth_m = -in_view.z;
  if (projected.depth_m <= 0) return projected;
  const glm::dvec4 clip = ClipFromView(camera, aspect) * in_view;
  projected.x_px = (clip.x / clip.w + 1) / 2 * width_px;
  projected.y_px = (1 - clip.y / clip.w) / 2 * height_px;
  projected.px_per_m =
      height_px / (camera.is_orthographic()
                       ? camera.ortho_height_m
                       : 2 * std::tan(0.5 * camera.vertical_fov_rad) * projected.depth_m);
  return projected;
}

std::optional<Eigen::Vector2d> FloorPointAt(double x_px, double y_px, const Camera& camera,
                                            int width_px, int height_px) {
  const double aspect = static_cast<double>(width_px) / height_px;
  const glm::dmat4 world_from_clip =
      glm::inverse(ClipFromView(camera, aspect) * ViewFromWorld(camera));
  const auto at_depth = [&](double depth) -> Eigen::Vector3d {
    const glm::dvec4 p =
        world_from_clip * glm::dvec4(2 * x_px / width_px - 1, 1 - 2 * y_px / height_px, depth, 1);
    return Eigen::Vector3d(p.x, p.y, p.z) / p.w;
  };
  const Eigen::Vector3d near = at_depth(-1), ray = at_depth(1) - near;
  const double along = -near.z() / ray.z();
  if (!(near.z() > 0 && along > 0 && std::isfinite(along))) return std::nullopt;
  const Eigen::Vector3d point = near + along * ray;
  return Eigen::Vector2d(point.x(), point.y());
}

std::optional<Eigen::Matrix3d> PlaneFromPicture(const Camera& camera, int width_px, int height_px,
                                                double z_m) {
  const double aspect = static_cast<double>(width_px) / height_px;
  const glm::dmat4 clip_from_world = ClipFromView(camera, aspect) * ViewFromWorld(camera);
  Eigen::Matrix3d clip_from_plane, clip_from_picture;
  constexpr int kRows[] = {0, 1, 3};  // x, y, w
  for (int i = 0; i < 3; ++i) {
    const int row = kRows[i];
    clip_from_plane.row(i) << clip_from_world[0][row], clip_from_world[1][row],
        z_m * clip_from_world[2][row] + clip_from_world[3][row];
  }
  // The corners of a square on the plane go round the same way where it is seen from above.
  if (!(clip_from_plane.determinant() > 0)) return std::nullopt;
  clip_from_picture << 2.0 / width_px, 0, -1, 0, -2.0 / height_px, 1, 0, 0, 1;
  return Eigen::Matrix3d(clip_from_plane.inverse() * clip_from_picture);
}

}  // namespace kinescope::render
