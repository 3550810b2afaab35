/// Renders tracked objects: a small block with the axes of its frame, x red, y green, z blue, and
/// its name. The shape of an object is not streamed.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class ObjectActors {
 public:
  /// Adds the objects' names to `labels`. @return whether the list of actors has changed.
  bool Update(const std::vector<TrackedObject>& objects, Liveness liveness,
              std::vector<Label>& labels);
  std::vector<vtkActor*> actors();
  /// By part of one of these actors: "object box"; empty: it is none of them.
  std::vector<std::string> NamesOf(const vtkActor* actor);
  void AddTo(PictureRegion& region) const;

 private:
  std::vector<std::unique_ptr<PartActor>> groups_;  // each with the objects of one draw call
  std::vector<std::string> names_;
};

}  // namespace kinescope::render
