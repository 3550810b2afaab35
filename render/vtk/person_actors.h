/// Renders all elements of one person. A new pose changes matrices; a new model changes the meshes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/once_log.h"
#include "render/scene_look.h"
#include "render/shape/floor_shadow.h"
#include "render/vtk/axes_actor.h"
#include "render/vtk/body_actor.h"
#include "render/vtk/force_arrows.h"
#include "render/vtk/part_actor.h"
#include "render/vtk/sphere_actor.h"

namespace kinescope::render {

class PersonActors {
 public:
  PersonActors();

  /// Adds the names of missing meshes to `labels`. `metres_per_pixel`: where the person is nearest
  /// to the camera.
  /// @return whether the list of actors has changed.
  bool Update(const PersonState& person, Liveness liveness, const Camera& camera,
              const SceneLook& look, double metres_per_pixel, OnceLog& log,
              std::vector<Label>& labels);

  /// Meshes that are replaced by boxes.
  const std::vector<std::string>& problems() const { return body_->problems(); }

  void AddLines(const Camera& camera, std::vector<SpaceLine>& lines) const {
    body_->AddLines(camera, lines);
  }

  // In rendering order; the shadows of all people come before the bodies of all people, and so on.
  vtkActor* shadow() { return shadow_.actor(); }
  /// Of a skin, to be blended into the floor; null: shadow() is shown, or none.
  const FloorShadow* floor_shadow() const { return has_floor_shadow_ ? &floor_shadow_ : nullptr; }
  std::vector<vtkActor*> bodies() { return body_->actors(); }
  /// Whether bodies() are translucent, and rendered after everything else.
  bool has_veil() const { return is_veil_; }
  std::vector<vtkActor*> ghosts();
  std::vector<vtkActor*> marks();
  vtkActor* held() { return held_.actor(); }
  /// By part of one of these actors as it was shown last: "left_knee", "centre of mass". One name:
  /// the actor is one thing. Empty: it is another's.
  std::vector<std::string> NamesOf(const vtkActor* actor);
  /// Of all of them that are visible.
  void AddTo(PictureRegion& region) const;

 private:
  void UpdateShadow(const PersonState& person, const SceneLook& look);
  void PlaceShadow(const PersonState& person);
  bool UpdateAxes(const PersonState& person, const SceneLook& look);
  void UpdateMarks(const PersonState& person, bool has_spheres, const Camera& camera,
                   double metres_per_pixel);
  void UpdateHeld(const PersonState& person, Liveness liveness);

  std::unique_ptr<BodyActor> body_;
  bool is_veil_ = false;
  FloorShadow floor_shadow_;
  bool has_floor_shadow_ = false;
  ForceArrows forces_;
  std::unique_ptr<AxesActor> frames_, joint_axes_;  // null: hidden
  PartActor shadow_, held_, ghost_marks_, marks_;
  SphereActor ghost_spheres_, spheres_;
  std::vector<SphereLook> looks_;
  std::vector<std::string> sphere_names_;  // of each of looks_
  std::vector<std::string> held_names_;    // by part
};

}  // namespace kinescope::render
