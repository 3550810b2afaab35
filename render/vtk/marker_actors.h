/// Renders the external markers in eight draw calls: what others lie on, then triangles, points and
/// lines, the opaque ones and the others. They are rebuilt when one of them has changed since the
/// picture before.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/once_log.h"
#include "render/shape/marker_shapes.h"
#include "render/vtk/line_actor.h"
#include "render/vtk/part_actor.h"
#include "render/vtk/point_actor.h"

namespace kinescope::render {

class MarkerActors {
 public:
  MarkerActors();

  /// Adds texts and the names of missing meshes to `labels`.
  void Update(const std::vector<std::shared_ptr<const SceneMarker>>& markers, OnceLog& log,
              std::vector<Label>& labels);

  /// As UnlitActor.
  void SetViewSize(int width_px, int height_px);

  /// Markers that are not rendered, or whose mesh is replaced by a box: one line each, with the
  /// marker and the reason.
  const std::vector<std::string>& problems() const { return problems_; }
  std::array<vtkActor*, 3> solid() {
    return {solid_.actor.actor(), solid_points_.actor(), solid_lines_.actor()};
  }
  std::array<vtkActor*, 5> blended() {
    return {ground_depth_.actor.actor(), ground_.actor.actor(), blended_.actor.actor(),
            blended_points_.actor(), blended_lines_.actor()};
  }
  /// By part of one of these actors: "marker walls/3".
  std::vector<std::string> NamesOf(const vtkActor* actor);
  void AddTo(PictureRegion& region) const;

 private:
  void Build();
  std::array<UnlitActor*, 4> Unlit() {
    return {&solid_points_, &blended_points_, &solid_lines_, &blended_lines_};
  }

  struct Surface {
    PartActor actor;
    std::vector<std::string> names;
  };
  std::array<Surface*, 4> Surfaces() { return {&ground_depth_, &ground_, &solid_, &blended_}; }
  static void Show(MarkerSurface& shape, Surface& surface);

  Surface ground_depth_{PartActor(Pass::kGroundDepth, PartActor::Light::kBelowThat, 1), {}},
      ground_{PartActor(Pass::kGround, PartActor::Light::kFlatBelow, 1), {}},
      solid_{PartActor(Pass::kSolid, PartActor::Light::kLit, 1), {}},
      blended_{PartActor(Pass::kBlended, PartActor::Light::kLit, 1), {}};
  PointActor solid_points_{false}, blended_points_{true};
  LineActor solid_lines_{false}, blended_lines_{true};
  MarkerReader reader_;
  std::vector<std::shared_ptr<const SceneMarker>> markers_;  // those that are built; held, so that
                                                             // their addresses are not reused
  std::vector<MarkerBox> boxes_;                             // world
  std::vector<Label> labels_;
  std::vector<std::string> problems_;
};

}  // namespace kinescope::render
