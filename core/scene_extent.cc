#include "core/scene_extent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace kinescope {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Vector3d;

constexpr std::size_t kMostOfMarker = 200, kMostOfAll = 20'000;  // points that are looked at

// Of a shape whose size is `scale` the two ends of its diagonal, whatever its rotation.
void AddShape(const SceneMarker& marker, const Vector3d& scale, std::vector<Vector3d>& places) {
  const Vector3d reach = Vector3d::Constant(0.5 * scale.cwiseAbs().maxCoeff());
  places.push_back(marker.pose.position - reach);
  places.push_back(marker.pose.position + reach);
}

// At most `most` of its points, in equal steps.
void AddPlaces(const SceneMarker& marker, std::size_t most, std::vector<Vector3d>& places) {
  if (marker.type == MarkerType::kText) {
    places.push_back(marker.pose.position);
    return;
  }
  if (marker.points.empty()) {
    // The scale of a mesh is a factor.
    const bool has_size = marker.type != MarkerType::kMesh;
    AddShape(marker, has_size ? marker.scale : Vector3d::Ones(), places);
    return;
  }
  const bool is_scaled = marker.type == MarkerType::kTriangleList;
  const std::size_t step = (marker.points.size() + most - 1) / most;
  for (std::size_t i = 0; i < marker.points.size(); i += step) {
    const Vector3d& point = marker.points[i];
    const Vector3d scaled = is_scaled ? point.cwiseProduct(marker.scale) : point;
    places.push_back(marker.pose.position + marker.pose.orientation * scaled);
  }
}

// Without the outermost on either side, if there are many.
AlignedBox3d BoxOfMost(const std::vector<Vector3d>& places) {
  constexpr std::size_t kFew = 50;
  constexpr double kLeftOut = 0.02;
  AlignedBox3d box;
  if (places.size() < kFew) {
    for (const Vector3d& place : places) box.extend(place);
    return box;
  }
  const auto edge = static_cast<std::ptrdiff_t>(kLeftOut * static_cast<double>(places.size()));
  std::vector<double> along(places.size());
  std::array<Vector3d, 2> corners;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    std::transform(places.begin(), places.end(), along.begin(),
                   [axis](const Vector3d& place) { return place[axis]; });
    std::nth_element(along.begin(), along.begin() + edge, along.end());
    corners[0][axis] = along[static_cast<std::size_t>(edge)];
    std::nth_element(along.begin(), along.end() - 1 - edge, along.end());
    corners[1][axis] = *(along.end() - 1 - edge);
  }
  return {corners[0], corners[1]};
}

// Half the diagonal of its size, m.
double ReachOf(const urdf::Geometry& geometry) {
  constexpr double kOfMesh = 0.2;  // files are not read for this
  switch (geometry.kind) {
    case urdf::Geometry::Kind::kBox: return 0.5 * geometry.size.norm();
    case urdf::Geometry::Kind::kCylinder:
      return std::hypot(geometry.size.x(), 0.5 * geometry.size.y());
    case urdf::Geometry::Kind::kSphere: return geometry.size.x();
    case urdf::Geometry::Kind::kMesh: break;
  }
  return kOfMesh;
}

// Of a robot whose bounds are not known.
void AddLinks(const RobotState& robot, AlignedBox3d& box) {
  const std::size_t count = std::min(robot.world_from_link.size(), robot.model->links.size());
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Isometry3d& link = robot.world_from_link[i];
    if (!link.translation().allFinite()) continue;
    for (const urdf::Visual& visual : robot.model->links[i].visuals) {
      const Vector3d middle = link * visual.link_from_visual.translation();
      const Vector3d reach = Vector3d::Constant(ReachOf(visual.geometry));
      if (!(middle + reach).allFinite()) continue;
      box.extend(AlignedBox3d(middle - reach, middle + reach));
    }
  }
}

AlignedBox3d BoxOf(const std::vector<RobotState>& robots) {
  AlignedBox3d box;
  for (const RobotState& robot : robots) {
    if (robot.bounds.isEmpty()) {
      AddLinks(robot, box);
    } else {
      box.extend(robot.bounds);
    }
  }
  return box;
}

AlignedBox3d Widened(const AlignedBox3d& box, double by) {
  const Vector3d all_sides = Vector3d::Constant(by);
  return {box.min() - all_sides, box.max() + all_sides};
}

}  // namespace

AlignedBox3d ExtentOf(const std::vector<RobotState>& robots, const MarkerList& markers) {
  std::vector<Vector3d> places;
  const std::size_t most = std::clamp<std::size_t>(
      kMostOfAll / std::max<std::size_t>(1, markers.size()), 2, kMostOfMarker);
  for (const auto& marker : markers) {
    if (marker->ns != kNamespaceOfGrids) AddPlaces(*marker, most, places);
  }
  const auto is_nowhere = [](const Vector3d& place) { return !place.allFinite(); };
  places.erase(std::remove_if(places.begin(), places.end(), is_nowhere), places.end());
  AlignedBox3d box = BoxOf(robots);
  if (box.isEmpty()) return BoxOfMost(places);
  constexpr double kNear = 1;  // in diagonals of the robots
  const AlignedBox3d near = Widened(box, kNear * box.diagonal().norm());
  const auto is_far = [&near](const Vector3d& place) { return !near.contains(place); };
  places.erase(std::remove_if(places.begin(), places.end(), is_far), places.end());
  return box.merged(BoxOfMost(places));
}

const AlignedBox3d& HeldExtent::Follow(const AlignedBox3d& now) {
  constexpr double kSpare = 0.1, kMuchSmaller = 0.5;  // of the diagonal
  if (now.isEmpty()) return held_;
  const double size = now.diagonal().norm();
  const bool fits = !held_.isEmpty() && held_.contains(now);
  if (fits && size > kMuchSmaller * held_.diagonal().norm()) return held_;
  // What has not moved yet is shown as it is.
  held_ = held_.isEmpty() ? now : Widened(now, kSpare * size);
  return held_;
}

}  // namespace kinescope
