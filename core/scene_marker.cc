#include "core/scene_marker.h"

#include <array>
#include <cmath>

namespace kinescope {
namespace {

constexpr std::array<const char*, 12> kNames = {
    "arrow",     "cube",        "sphere", "cylinder", "line strip", "line list",
    "cube list", "sphere list", "points", "text",     "mesh",       "triangle list"};

std::optional<std::string> FindPointDefect(const SceneMarker& marker) {
  const std::size_t count = marker.points.size();
  const auto have = [&](const char* need) {
    return std::string(Name(marker.type)) + " has " + std::to_string(count) + " points; expected " +
           need;
  };
  if (count > kMaxMarkerPoints) {
    return have("at most ") + std::to_string(kMaxMarkerPoints);
  }
  switch (marker.type) {
    case MarkerType::kArrow:
      if (count != 0 && count != 2) return have("0 or 2");
      break;
    case MarkerType::kLineStrip:
      if (count < 2) return have("2 or more");
      break;
    case MarkerType::kLineList:
      if (count == 0 || count % 2 != 0) return have("pairs of points");
      break;
    case MarkerType::kTriangleList:
      if (count == 0 || count % 3 != 0) return have("triples of points");
      break;
    case MarkerType::kCubeList:
    case MarkerType::kSphereList:
    case MarkerType::kPoints:
      if (count == 0) return have("1 or more");
      break;
    default: break;
  }
  for (const Eigen::Vector3d& point : marker.points) {
    if (!IsWithinReach(point)) return "a point is not finite, or is beyond 100 km";
  }
  return std::nullopt;
}

std::optional<std::string> FindColorDefect(const SceneMarker& marker) {
  const auto is_color = [](const Eigen::Vector4d& color) {
    return color.allFinite() && color.minCoeff() >= 0 && color.maxCoeff() <= 1;
  };
  if (!is_color(marker.color)) return "its color is not within 0 to 1";
  if (!marker.colors.empty() && marker.colors.size() != marker.points.size()) {
    return std::to_string(marker.colors.size()) + " colors for " +
           std::to_string(marker.points.size()) + " points";
  }
  for (const Eigen::Vector4d& color : marker.colors) {
    if (!is_color(color)) return "one of its colors is not within 0 to 1";
  }
  return std::nullopt;
}

// How many of the scale's numbers must be above 0.
int NeededSizes(const SceneMarker& marker) {
  switch (marker.type) {
    case MarkerType::kLineStrip:
    case MarkerType::kLineList: return 1;
    case MarkerType::kPoints: return 2;
    case MarkerType::kSphereList: return 1;
    case MarkerType::kArrow: return marker.points.empty() ? 3 : 1;
    case MarkerType::kText: return 0;
    default: return 3;
  }
}

std::optional<std::string> FindSizeDefect(const SceneMarker& marker) {
  if (!IsWithinReach(marker.scale)) return "its scale is not finite, or is beyond 100 km";
  // A mesh may be mirrored.
  const bool may_mirror =
      marker.type == MarkerType::kMesh || marker.type == MarkerType::kTriangleList;
  const Eigen::Vector3d scale =
      may_mirror ? Eigen::Vector3d(marker.scale.cwiseAbs()) : marker.scale;
  if (scale.minCoeff() < 0) return "its scale is negative";
  const int needed = NeededSizes(marker);
  for (int axis = 0; axis < needed; ++axis) {
    if (!(scale[axis] > 0)) return std::string("its scale.") + "xyz"[axis] + " is 0";
  }
  if (marker.type == MarkerType::kText && !(scale.z() > 0)) return "its scale.z is 0";
  return std::nullopt;
}

// Of its text, or of the name of its mesh.
std::optional<std::string> FindNameDefect(const SceneMarker& marker) {
  if (marker.type == MarkerType::kText) {
    if (marker.text.empty()) return "its text is empty";
    if (marker.text.size() > kMaxMarkerText) return "its text is longer than 1000 bytes";
  }
  if (marker.type == MarkerType::kMesh && marker.mesh_uri.empty()) return "its mesh name is empty";
  return std::nullopt;
}

}  // namespace

bool IsWithinReach(const Eigen::Vector3d& point) {
  return point.allFinite() && point.cwiseAbs().maxCoeff() <= kFarthestMarker;
}

const char* Name(MarkerType type) {
  const auto index = static_cast<std::size_t>(type);
  return index < kNames.size() ? kNames[index] : "unknown";
}

std::optional<MarkerDefect> FindDefect(const SceneMarker& marker) {
  const Eigen::Quaterniond& turn = marker.pose.orientation;
  if (static_cast<std::size_t>(marker.type) >= kNames.size()) {
    return MarkerDefect{"its type", "its type is " + std::to_string(static_cast<int>(marker.type)) +
                                        "; expected 0 to 11"};
  }
  if (marker.type != MarkerType::kText && !marker.text.empty()) {
    return MarkerDefect{"its history", marker.text};
  }
  if (!IsWithinReach(marker.pose.position)) {
    return MarkerDefect{"its position", "its position is not finite, or is beyond 100 km"};
  }
  if (!turn.coeffs().allFinite() || std::abs(turn.norm() - 1) > 1e-3) {
    return MarkerDefect{"its orientation", "its orientation is not a unit quaternion"};
  }
  if (const auto defect = FindSizeDefect(marker)) return MarkerDefect{"its scale", *defect};
  if (const auto defect = FindPointDefect(marker)) return MarkerDefect{"its points", *defect};
  if (const auto defect = FindColorDefect(marker)) return MarkerDefect{"its colors", *defect};
  if (const auto defect = FindNameDefect(marker)) return MarkerDefect{"its text", *defect};
  return std::nullopt;
}

std::string IdentityOf(const SceneMarker& marker) {
  return marker.ns + "/" + std::to_string(marker.id);
}

}  // namespace kinescope
