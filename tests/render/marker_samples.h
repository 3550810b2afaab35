/// One marker of each type, in the order of MarkerType, side by side.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/scene_marker.h"

namespace kinescope::testing {

inline std::vector<SceneMarker> MarkersOfAllTypes(const std::string& mesh_uri) {
  std::vector<SceneMarker> markers;
  const auto add = [&](MarkerType type, const Eigen::Vector3d& scale) -> SceneMarker& {
    SceneMarker marker;
    marker.ns = "samples";
    marker.id = static_cast<int>(markers.size());
    marker.type = type;
    const int column = marker.id % 4, row = marker.id / 4;
    marker.pose.position = {0, 1.2 - 0.8 * column, 1.5 - 0.65 * row};
    marker.scale = scale;
    marker.color = {0.20, 0.45, 0.75, 1};
    markers.push_back(marker);
    return markers.back();
  };
  const auto zigzag = [](SceneMarker& marker, int count) {
    for (int i = 0; i < count; ++i) {
      marker.points.push_back({0, 0.5 * i / (count - 1) - 0.25, 0.14 * (i % 2) - 0.07});
      marker.colors.push_back({0.20, 0.45 + 0.4 * i / count, 0.75, 1});
    }
  };
  SceneMarker& arrow = add(MarkerType::kArrow, {0.03, 0.08, 0.12});
  arrow.points = {{0, -0.25, -0.1}, {0, 0.25, 0.1}};
  add(MarkerType::kCube, {0.3, 0.3, 0.2}).pose.orientation =
      Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  add(MarkerType::kSphere, {0.35, 0.35, 0.25});
  add(MarkerType::kCylinder, {0.2, 0.2, 0.35});
  zigzag(add(MarkerType::kLineStrip, {0.02, 0, 0}), 7);
  zigzag(add(MarkerType::kLineList, {0.02, 0, 0}), 8);
  zigzag(add(MarkerType::kCubeList, {0.05, 0.05, 0.05}), 6);
  zigzag(add(MarkerType::kSphereList, {0.07, 0.07, 0.07}), 6);
  zigzag(add(MarkerType::kPoints, {0.02, 0.02, 0}), 30);
  SceneMarker& text = add(MarkerType::kText, {0, 0, 0.14});
  text.text = "text";
  SceneMarker& mesh = add(MarkerType::kMesh, {0.12, 0.12, 0.12});
  mesh.mesh_uri = mesh_uri;
  SceneMarker& triangles = add(MarkerType::kTriangleList, {1, 1, 1});
  for (int i = 0; i < 6; ++i) {
    const double angle = M_PI / 3 * i, next = M_PI / 3 * (i + 1);
    triangles.points.push_back({0.08, 0, 0});
    triangles.points.push_back({0, 0.22 * std::cos(angle), 0.22 * std::sin(angle)});
    triangles.points.push_back({0, 0.22 * std::cos(next), 0.22 * std::sin(next)});
  }
  return markers;
}

}  // namespace kinescope::testing
