#include "server/ros/marker_message.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace kinescope::ros_bridge {
namespace {

using visualization_msgs::Marker;

template <class RosVector>
Eigen::Vector3d FromMarker(const RosVector& v) {
  return {v.x, v.y, v.z};
}

Eigen::Quaterniond FromMarker(const geometry_msgs::Quaternion& q) {
  const Eigen::Quaterniond turn(q.w, q.x, q.y, q.z);
  const double norm = turn.norm();
  // A message without an orientation is the most frequent one.
  if (norm == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(turn.coeffs() / norm);  // non-finite values are detected later
}

// Checked before anything is copied.
std::optional<std::string> FindExcess(const Marker& message) {
  if (message.ns.size() > kLongestMarkerName ||
      message.header.frame_id.size() > kLongestMarkerName) {
    return fmt::format("name of the namespace or frame longer than {} bytes", kLongestMarkerName);
  }
  constexpr std::size_t kLongestUri = 4096;
  if (message.mesh_resource.size() > kLongestUri) {
    return fmt::format("mesh name of {} bytes: expected at most {}", message.mesh_resource.size(),
                       kLongestUri);
  }
  return std::nullopt;
}

// As many points belong together.
std::size_t PointsOfOne(MarkerType type) {
  return type == MarkerType::kLineList ? 2 : type == MarkerType::kTriangleList ? 3 : 1;
}

// Of more than kMaxMarkerPoints, those of as many lines, triangles, cubes, ... with equal distances
// in the message. @return false: the colours of so many cannot be told from their number
bool CopyPoints(const Marker& message, SceneMarker& marker) {
  const std::size_t together = PointsOfOne(marker.type), count = message.points.size();
  const bool is_arrow = marker.type == MarkerType::kArrow;
  // As in RViz, triangles may have one color each.
  const bool has_face_colors =
      marker.type == MarkerType::kTriangleList && 3 * message.colors.size() == count;
  const bool has_colors = message.colors.size() == count;
  if (count <= kMaxMarkerPoints && message.colors.size() <= kMaxMarkerPoints) {
    for (const auto& point : message.points) marker.points.push_back(FromMarker(point));
    for (const auto& color : message.colors) {
      if (is_arrow) break;
      marker.colors.insert(marker.colors.end(), has_face_colors ? 3 : 1, ColorOf(color));
    }
    return true;
  }
  const bool is_known = has_colors || has_face_colors || message.colors.empty();
  if (is_arrow || !is_known || count % together != 0) return false;
  const std::uint64_t all = count / together, kept = kMaxMarkerPoints / together;
  for (std::uint64_t i = 0; i < kept; ++i) {
    const auto one = static_cast<std::size_t>(i * all / kept);
    for (std::size_t k = one * together; k < (one + 1) * together; ++k) {
      marker.points.push_back(FromMarker(message.points[k]));
      if (has_colors) marker.colors.push_back(ColorOf(message.colors[k]));
      if (has_face_colors) marker.colors.push_back(ColorOf(message.colors[one]));
    }
  }
  return true;
}

// What has one goes, with its colours: a line, a triangle, one of many cubes.
void DropFarPoints(SceneMarker& marker) {
  const std::size_t together = PointsOfOne(marker.type), count = marker.points.size();
  const bool has_colors = marker.colors.size() == count;
  if (marker.type == MarkerType::kArrow || count % together != 0) return;
  const auto at = [](std::size_t i) { return static_cast<std::ptrdiff_t>(i); };
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; i += together) {
    const auto first = marker.points.begin() + at(i);
    if (!std::all_of(first, first + at(together), IsWithinReach)) continue;
    for (std::size_t k = i; k < i + together; ++k, ++kept) {
      marker.points[kept] = marker.points[k];
      if (has_colors) marker.colors[kept] = marker.colors[k];
    }
  }
  marker.points.resize(kept);
  if (has_colors) marker.colors.resize(kept);
}

// RViz takes a size below 0 for one above, except of an arrow, which points the other way, and
// draws what is flat.
void MakeSolid(SceneMarker& marker) {
  constexpr double kFlat = 1e-5;  // m
  switch (marker.type) {
    case MarkerType::kMesh:
    case MarkerType::kTriangleList:
    case MarkerType::kText: return;
    case MarkerType::kArrow:
      if (!marker.points.empty() || !(marker.scale.x() < 0)) break;
      marker.pose.orientation =
          marker.pose.orientation * Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitZ());
      break;
    default: break;
  }
  marker.scale = marker.scale.cwiseAbs();
  const bool has_volume = marker.type == MarkerType::kCube || marker.type == MarkerType::kSphere ||
                          marker.type == MarkerType::kCylinder ||
                          marker.type == MarkerType::kCubeList;
  if (has_volume && marker.scale.allFinite() && !marker.scale.isZero()) {
    marker.scale = marker.scale.cwiseMax(kFlat);
  }
}

// @return at most `most` bytes, with an ellipsis if something is left out
std::string Shortened(const std::string& text, std::size_t most) {
  constexpr char kEllipsis[] = "\u2026";
  if (text.size() <= most) return text;
  std::size_t end = most - (sizeof kEllipsis - 1);
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + kEllipsis;
}

}  // namespace

Eigen::Vector4d ColorOf(const std_msgs::ColorRGBA& color) {
  const Eigen::Vector4d rgba(color.r, color.g, color.b, color.a);
  return rgba.allFinite() ? Eigen::Vector4d(rgba.cwiseMax(0).cwiseMin(1)) : rgba;
}

bool HasPoints(MarkerType type) {
  switch (type) {
    case MarkerType::kArrow:
    case MarkerType::kLineStrip:
    case MarkerType::kLineList:
    case MarkerType::kCubeList:
    case MarkerType::kSphereList:
    case MarkerType::kPoints:
    case MarkerType::kTriangleList: return true;
    default: return false;
  }
}

Refusal RefusalOf(const char* kind, const Marker& message, const std::string& why) {
  return {kind, fmt::format("marker {}/{}: {}", message.ns.substr(0, kLongestMarkerName),
                            message.id, why)};
}

Taken<SceneMarker> ToSceneMarker(const Marker& message) {
  if (const auto excess = FindExcess(message))
    return tl::unexpected(RefusalOf("too large", message, *excess));
  SceneMarker marker;
  marker.ns = message.ns;
  marker.id = message.id;
  marker.type = static_cast<MarkerType>(message.type);
  marker.pose = {FromMarker(message.pose.position), FromMarker(message.pose.orientation)};
  marker.scale = FromMarker(message.scale);
  marker.color = ColorOf(message.color);
  if (HasPoints(marker.type)) {
    if (!CopyPoints(message, marker)) {
      return tl::unexpected(RefusalOf(
          "its colors", message,
          fmt::format("{} points and {} colors", message.points.size(), message.colors.size())));
    }
    DropFarPoints(marker);
  }
  if (marker.type == MarkerType::kText) marker.text = Shortened(message.text, kMaxMarkerText);
  if (marker.type == MarkerType::kMesh) {
    marker.mesh_uri = message.mesh_resource;
    marker.mesh_has_own_colors = message.mesh_use_embedded_materials != 0;
  }
  MakeSolid(marker);
  if (const auto defect = FindDefect(marker)) {
    return tl::unexpected(RefusalOf(defect->kind, message, defect->text));
  }
  return marker;
}

}  // namespace kinescope::ros_bridge
