/// A marker of another node (visualization_msgs/Marker) as plain data. The receiver
/// (server/ros/marker_input.h) resolves its frame, applies its action and removes it after its
/// lifetime; every marker in a scene is rendered. World frame, metres, colours sRGB with opacity,
/// 0..1. Source of types and sizes: wiki.ros.org/rviz/DisplayTypes/Marker and the comments of the
/// message.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "urdf/kinematics.h"

namespace kinescope {

/// Values as in the message.
enum class MarkerType {
  kArrow = 0,   // two points: from, to; scale: shaft and head diameter, head length (0: 0.23 of the
                // arrow). No points: along +x; scale: length, shaft's width and height; head: twice
  kCube = 1,    // scale: edges
  kSphere = 2,  // scale: diameters
  kCylinder = 3,      // along z; scale: diameters, height
  kLineStrip = 4,     // points are joined; scale.x: width, round
  kLineList = 5,      // one line per two points; scale.x: width, round
  kCubeList = 6,      // one cube per point; scale: edges
  kSphereList = 7,    // one sphere per point; scale.x: diameter
  kPoints = 8,        // one square per point that faces the viewer, unlit; scale: width, height
  kText = 9,          // faces the viewer, lines from top to bottom; scale.z: height of a line
  kMesh = 10,         // scale: factors
  kTriangleList = 11  // three points each, visible from both sides; scale: factors
};

/// "arrow", "cube", "sphere", "cylinder", "line strip", "line list", "cube list", "sphere list",
/// "points", "text", "mesh", "triangle list".
const char* Name(MarkerType type);

/// Of flat things that others lie on, in the order in which they are drawn.
enum class GroundLayer { kNone, kFirstMap, kMap, kCells };

struct SceneMarker {
  std::string ns;  // namespace; with `id` its identity
  int id = 0;
  MarkerType type = MarkerType::kCube;
  urdf::Pose pose;  // world_from_marker
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector4d color = Eigen::Vector4d::Ones();
  std::vector<Eigen::Vector3d> points;  // in the marker's frame
  std::vector<Eigen::Vector4d> colors;  // one per point, or empty: `color` for all
  std::string text;                     // of other types: why it cannot be rendered, or ""
  std::string mesh_uri;                 // package://, file:// or an absolute path
  bool mesh_has_own_colors = false;     // use colours of the file, where it has any, instead of
                                        // `color`
  bool is_in_pixels = false;  // of kPoints: scale is in pixels of the picture, not in m; of
                              // kLineList and kLineStrip: lines of one pixel
  // Of kTriangleList: unlit, and whatever lies on it is seen whole.
  GroundLayer ground = GroundLayer::kNone;
};

/// Of the axes, arrows and names of all frames of TF, which need no legend.
inline constexpr char kNamespaceOfFrames[] = "tf";
/// Of grids, which need no legend, and are no part of what a camera frames.
inline constexpr char kNamespaceOfGrids[] = "rviz/Grid";

/// Of axes that mark a frame, which need no legend either.
inline constexpr char kNamespaceOfAxes[] = "rviz/Axes";

/// All that stand in a scene at a time.
using MarkerList = std::vector<std::shared_ptr<const SceneMarker>>;

constexpr std::size_t kMaxMarkerPoints = 100'000;  // per marker
constexpr std::size_t kMaxMarkerText = 1000;       // bytes
constexpr double kFarthestMarker = 1e5;  // m; limit of the distance from the origin and of any size

/// False of what is not finite, too.
[[nodiscard]] bool IsWithinReach(const Eigen::Vector3d& point);

/// Why a marker cannot be rendered.
struct MarkerDefect {
  const char* kind;  // "its scale", from a fixed set
  std::string text;  // "its scale is negative"
};
/// nullopt if it has none.
[[nodiscard]] std::optional<MarkerDefect> FindDefect(const SceneMarker& marker);

/// "walls/3", as used in messages.
std::string IdentityOf(const SceneMarker& marker);

}  // namespace kinescope
