/// Meshes of what is held: a drill, a screwdriver, whatever its user has a file of. Only its look:
/// its mass and centre of mass are set as a hand load.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "server/options/value.h"
#include "urdf/mesh_fit.h"
#include "urdf/skeleton.h"

namespace kinescope::app {

/// A mesh file and where it is held.
struct ToolFile {
  std::string path;  // STL, DAE, OBJ or GLB
  /// Of the hand's link frame; nullopt: at the grip, with the axes of the hand's link.
  std::optional<Eigen::Isometry3d> hand_from_tool;
};

/// "right:FILE", "left:FILE@X,Y,Z" or "left:FILE@X,Y,Z,ROLL,PITCH,YAW" (m and rad; turned about the
/// fixed axes x, y and z in that order, as URDF does), or both with ';' between. The last '@'
/// counts: a file's name may have others. "": none.
class ToolsValue : public options::ValueOf<std::array<std::optional<ToolFile>, 2>> {
 public:
  ToolsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;
  std::vector<std::string> Names() const override { return {"right", "left"}; }
  std::vector<std::filesystem::path> Files() const override;
  void SetFolder(const std::filesystem::path& folder) override;
  bool is_empty() const { return !value_[urdf::kRight] && !value_[urdf::kLeft]; }

 private:
  std::string text_;
};

struct HandTool {
  urdf::TriangleMesh mesh;  // m, z up
  /// Of the hand's link frame; nullopt: at the grip, with the axes of the hand's link.
  std::optional<Eigen::Isometry3d> hand_from_tool;
};

using HandTools = std::array<std::optional<HandTool>, 2>;  // by urdf::Side

/// Unit and up axis of `convention` are those of STL and OBJ, the others tell their own. Null where
/// `files` is empty.
/// @throws UsageError naming the file that cannot be read or is too small or too large to be held.
std::shared_ptr<const HandTools> ReadHandTools(const ToolsValue& files,
                                               const urdf::MeshConvention& convention);

/// Its surface in the link frame of the hand of `side`.
[[nodiscard]] urdf::TriangleMesh ToHandFrame(const HandTool& tool, const urdf::Skeleton& skeleton,
                                             urdf::Side side);

}  // namespace kinescope::app
