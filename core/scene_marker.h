/// A shape that somebody else wants to see in the scene: what visualization_msgs/Marker says, as
/// plain data. Frames are resolved, actions applied and lifetimes kept by whoever fills it; a
/// marker that is in a scene is drawn. World frame, metres, colours sRGB with opacity, 0..1. Source
/// of types and sizes: wiki.ros.org/rviz/DisplayTypes/Marker and the message's own comments.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "urdf/kinematics.h"

namespace kinescope {

/// Values as in the message.
enum class MarkerType {
  kArrow = 0,       // two points: from, to; scale: shaft and head diameter, head length (0: 0.23 of
                    // the arrow). No points: along +x; scale: length, width, height
  kCube = 1,        // scale: edges
  kSphere = 2,      // scale: diameters
  kCylinder = 3,    // along z; scale: diameters, height
  kLineStrip = 4,   // scale.x: width, drawn round; likewise
  kLineList = 5,    // ... pairs of points
  kCubeList = 6,    // at every point; scale: edges
  kSphereList = 7,  // likewise, diameters
  kPoints = 8,      // at every point a cube; scale: width, height
  kText = 9,        // faces whoever looks; scale.z: height of a capital
  kMesh = 10,       // scale: factors
  kTriangleList = 11  // triples of points, seen from both sides; scale: factors
};

/// "arrow", "cube", "sphere", "cylinder", "line strip", "line list", "cube list", "sphere list",
/// "points", "text", "mesh", "triangle list".
const char* Name(MarkerType type);

struct SceneMarker {
  std::string ns;  // with `id` its identity, shown in messages
  int id = 0;
  MarkerType type = MarkerType::kCube;
  urdf::Pose pose;  // world_from_marker
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector4d color = Eigen::Vector4d::Ones();
  std::vector<Eigen::Vector3d> points;  // in the marker's frame
  std::vector<Eigen::Vector4d> colors;  // one for each point, or none: `color` for all
  std::string text;
  std::string mesh_uri;              // package://, file:// or absolute
  bool mesh_has_own_colors = false;  // those of the file, where it has any, instead of `color`
};

constexpr std::size_t kMostMarkerPoints = 100'000;  // of one marker
constexpr std::size_t kMostMarkerText = 200;        // bytes
constexpr double kFarthestMarker = 1e5;             // m, from the origin, and of any size

/// Why `marker` must not be drawn, such as "its scale is not a finite number"; nullopt when nothing
/// is wrong with it.
[[nodiscard]] std::optional<std::string> FindDefect(const SceneMarker& marker);

/// "walls/3", as messages name it.
std::string IdentityOf(const SceneMarker& marker);

}  // namespace kinescope
