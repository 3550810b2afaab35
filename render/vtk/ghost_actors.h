/// Renders reference poses: translucent second bodies.
#pragma once

#include <memory>
#include <vector>

#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/scene_look.h"
#include "render/vtk/body_actor.h"

namespace kinescope::render {

class GhostActors {
 public:
  /// Adds the names of missing meshes to `labels`. @return whether the list of actors has changed.
  bool Update(const SceneLook& look, OnceLog& log, std::vector<Label>& labels);
  std::vector<vtkActor*> actors();
  /// Of the pose that an actor is of; -1: of none.
  int IndexOf(const vtkActor* actor);
  void AddTo(PictureRegion& region) const;

 private:
  std::vector<std::unique_ptr<BodyActor>> bodies_;
};

}  // namespace kinescope::render
