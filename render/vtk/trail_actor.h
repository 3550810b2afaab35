/// Renders trails: lines that become thicker towards the current position of the point. Rebuilt for
/// every picture, because the history is different in each.
#pragma once

#include <string>
#include <vector>

#include "render/camera/picture_region.h"
#include "render/scene_look.h"
#include "render/vtk/part_actor.h"

namespace kinescope::render {

class TrailActor {
 public:
  TrailActor() : part_(Pass::kSolid, PartActor::Light::kLit, 1) {}
  void Show(const std::vector<Trail>& trails);
  vtkActor* actor() { return part_.actor(); }
  /// By part of the actor: "trail of left_hand".
  const std::vector<std::string>& names() const { return names_; }
  void AddTo(PictureRegion& region) const;

 private:
  PartActor part_;
  urdf::Mesh mesh_;  // world
  std::vector<std::string> names_;
};

}  // namespace kinescope::render
