/// Tracked objects: a small block with the axes of its frame, x red, y green, z blue, and its name.
/// What an object looks like is not streamed.
#pragma once

#include <memory>
#include <vector>

#include "core/scene_state.h"
#include "render/module.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class ObjectActors {
 public:
  /// Adds the objects' names to `labels`. @return whether there are other actors than before.
  bool Update(const std::vector<TrackedObject>& objects, Liveness liveness,
              std::vector<Label>& labels);
  std::vector<vtkActor*> actors();

 private:
  std::vector<std::unique_ptr<PartActor>> groups_;  // each of as many objects as it can take
};

}  // namespace kinescope::render
