/// Everything that is drawn of one person. A new pose changes matrices; a new model, the mesh.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "render/module.h"
#include "render/vtk/figure_mesh.h"
#include "render/vtk/once_log.h"
#include "render/vtk/part_actor.h"
#include "render/vtk/sphere_actor.h"
#include "server/core/scene_state.h"

namespace kinescope::render {

class PersonActors {
 public:
  PersonActors();

  /// Adds names of missing meshes to `labels`.
  void Update(const PersonState& person, Liveness liveness, const Camera& camera, OnceLog& log,
              std::vector<Label>& labels);

  /// Meshes that are boxes instead.
  const std::vector<std::string>& problems() const { return problems_; }

  // In the order of drawing; all people's shadows come before anybody's body, and so on.
  vtkActor* shadow() { return shadow_.actor(); }
  vtkActor* body() { return body_.actor(); }
  std::vector<vtkActor*> ghosts() { return {ghost_marks_.actor(), ghost_spheres_.actor()}; }
  std::vector<vtkActor*> marks() { return {marks_.actor(), spheres_.actor()}; }

 private:
  void UpdateBody(const PersonState& person, Liveness liveness, OnceLog& log,
                  std::vector<Label>& labels);
  void UpdateShadow(const PersonState& person);
  void UpdateMarks(const PersonState& person, const Camera& camera);

  PartActor shadow_, body_, ghost_marks_, marks_;
  SphereActor ghost_spheres_, spheres_;
  std::shared_ptr<const PersonModel> model_;  // whose mesh is loaded; held, so that no other model
                                              // can come to lie at its address
  std::uint64_t revision_ = 0;
  std::vector<VisualMesh::Placeholder> placeholders_;
  std::vector<std::string> problems_;
  std::vector<SphereLook> looks_;
};

}  // namespace kinescope::render
