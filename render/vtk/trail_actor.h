/// Trails: lines that grow towards where the point is now. Built anew for every picture: the past
/// that they show is part of it.
#pragma once

#include <vector>

#include "render/scene_look.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class TrailActor {
 public:
  TrailActor() : part_(Pass::kSolid, PartActor::Light::kLit, 1) {}
  void Show(const std::vector<Trail>& trails);
  vtkActor* actor() { return part_.actor(); }

 private:
  PartActor part_;
};

}  // namespace kinescope::render
