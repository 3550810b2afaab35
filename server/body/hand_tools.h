/// Meshes of what is held: a drill, a screwdriver, whatever its user has a file of. Only its look:
/// what it weighs, and where, is told as a hand load.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <optional>
#include <string>

#include "urdf/mesh_fit.h"
#include "urdf/skeleton.h"

namespace kinescope::app {

struct HandTool {
  urdf::TriangleMesh mesh;  // m, z up
  /// Of the hand's link frame; nullopt: at the grip, with the axes of the hand's link.
  std::optional<Eigen::Isometry3d> hand_from_tool;
};

using HandTools = std::array<std::optional<HandTool>, 2>;  // by urdf::Side

/// "right:FILE", "left:FILE@X,Y,Z" or "left:FILE@X,Y,Z,ROLL,PITCH,YAW" (m and rad; turned about the
/// fixed axes x, y and z in that order, as URDF does), or both with ';' between. FILE: STL, DAE,
/// OBJ or GLB. Unit and up axis of `convention` are those of STL and OBJ, the others tell their
/// own. Null where `text` is "".
/// @throws UsageError naming option, value and what is wrong, or the file that cannot be read or is
/// too small or too large to be held.
std::shared_ptr<const HandTools> ReadHandTools(const std::string& text,
                                               const urdf::MeshConvention& convention);

/// Its surface in the link frame of the hand of `side`.
[[nodiscard]] urdf::TriangleMesh ToHandFrame(const HandTool& tool, const urdf::Skeleton& skeleton,
                                             urdf::Side side);

}  // namespace kinescope::app
