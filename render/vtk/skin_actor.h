/// Renders a person as one skinned surface (urdf/skin): the built-in one in a suit, or one of the
/// user's own. A new pose moves its vertices; a new model makes a new surface.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/shape/visible_lines.h"
#include "render/vtk/shaded_actor.h"
#include "render/vtk/skin_shader.h"
#include "render/vtk/skin_surface.h"
#include "urdf/skin/occlusion.h"

namespace kinescope::render {

class SkinActor {
 public:
  explicit SkinActor(Pass pass = Pass::kSolid) : pass_(pass) {}

  /// `own`: instead of the built-in skin; or null. `override_color`, `opacity`: see PartActor.
  /// `error_m`: how far the drawn surface may be from the skin; 0: not at all. `shading.is_suit`:
  /// without `own`. `shading.has_borders` is ignored.
  /// @return whether the list of actors has changed.
  bool Update(const PersonState& person, const std::shared_ptr<const skin::SkinTemplate>& own,
              const Eigen::Vector4f& override_color, double opacity, double error_m,
              const SkinShading& shading);
  void SetVisible(bool is_visible) { is_visible_ = is_visible; }
  std::vector<vtkActor*> actors();
  /// Of the newest Update, if it is visible.
  void AddTo(PictureRegion& region) const;
  /// Of the newest Update: see SkinLines.
  void AddLines(const Camera& camera, std::vector<SpaceLine>& lines) const;
  /// Of the newest Update: what casts shadows.
  const skin::Capsules& capsules() const { return capsules_; }

 private:
  using Actors = std::vector<std::unique_ptr<ShadedActor>>;
  // The skin with some of its triangles; the actors share its vertices.
  struct Level {
    std::unique_ptr<SkinSurface> surface;
    std::map<SkinShading, Actors> actors;
  };
  std::unique_ptr<SkinSurface> SurfaceWithin(double error_m) const;
  void AddActors(const SkinShading& shading, Level& level) const;
  void Show(const PersonState& person, const Eigen::Vector4f& override_color, double opacity,
            const SkinShading& shading, ShadedActor& shaded) const;

  const Pass pass_;
  bool is_visible_ = true;
  std::shared_ptr<const PersonModel> model_;  // the loaded one
  std::uint64_t revision_ = 0;
  std::shared_ptr<const skin::SkinTemplate> own_;  // null: the built-in one
  skin::Build build_;
  skin::Capsules capsules_;
  std::map<double, Level> levels_;  // by error, m
  const Level* shown_ = nullptr;
};

}  // namespace kinescope::render
