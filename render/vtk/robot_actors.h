/// Renders all elements of one robot. New link poses change matrices; a new model changes the
/// meshes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/once_log.h"
#include "render/scene_look.h"
#include "render/shape/visual_mesh.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class RobotActors {
 public:
  RobotActors();

  /// Adds the names of missing meshes to `labels`. @return whether the list of actors has changed.
  bool Update(const RobotState& robot, const SceneLook& look, OnceLog& log,
              std::vector<Label>& labels);

  /// The smallest axis-aligned box around the shapes that Update has placed, world, m. Reads every
  /// vertex.
  Eigen::AlignedBox3d Measure(const RobotState& robot) const;
  bool IsOf(const RobotState& robot) const {
    return model_ == robot.model && meshes_ == robot.meshes;
  }
  /// Meshes that are replaced by boxes.
  const std::vector<std::string>& problems() const { return problems_; }

  vtkActor* shadow() { return shadow_.actor(); }
  /// Those that are opaque, or those that shine through.
  std::vector<vtkActor*> bodies(bool are_translucent);
  void AddTo(PictureRegion& region) const;

 private:
  // The links of one draw call.
  struct Group {
    std::unique_ptr<PartActor> actor;
    bool is_translucent = false;
    std::vector<std::size_t> links;          // by part
    std::vector<Eigen::Vector3f> positions;  // vertices of the mesh
    std::vector<float> parts;                // the part of each vertex
    std::vector<VisualMesh::Placeholder> placeholders;
  };
  void Load(const RobotState& robot, OnceLog& log);
  void LoadGroups(const urdf::RobotModel& model, bool is_translucent, VisualReader& reader);
  void AddGroup(VisualMesh mesh, std::vector<std::size_t> links, bool is_translucent);
  void UpdateShadow(const Eigen::AlignedBox3d& around);

  PartActor shadow_;
  std::vector<Group> groups_;
  std::shared_ptr<const urdf::RobotModel> model_;  // the loaded model; held, so that its address is
                                                   // not reused
  std::shared_ptr<const urdf::MeshSearch> meshes_;
  std::vector<std::string> problems_;
};

}  // namespace kinescope::render
