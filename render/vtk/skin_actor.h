/// Renders a person as one skinned surface (urdf/skin): the built-in one in a suit, or one of the
/// user's own. A new pose moves its vertices; a new model makes a new surface.
#pragma once

#include <vtkFloatArray.h>
#include <vtkNew.h>

#include <cstdint>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "render/shape/visible_lines.h"
#include "render/vtk/shaded_actor.h"
#include "render/vtk/skin_shader.h"
#include "urdf/skin/occlusion.h"
#include "urdf/skin/outfit.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::render {

class SkinActor {
 public:
  explicit SkinActor(Pass pass = Pass::kSolid) : pass_(pass) {}

  /// `own`: instead of the built-in skin; or null. `override_color`, `opacity`: see PartActor.
  /// `error_m`: how far the drawn surface may be from the skin; 0: not at all. `shading.is_suit`:
  /// without `own`.
  /// @return whether the list of actors has changed.
  bool Update(const PersonState& person, const std::shared_ptr<const skin::SkinTemplate>& own,
              const Eigen::Vector4f& override_color, double opacity, double error_m,
              const SkinShading& shading);
  void SetVisible(bool is_visible) { is_visible_ = is_visible; }
  std::vector<vtkActor*> actors();
  /// Of the newest Update: outlines as seen by `camera`, and the borders of the suit.
  void AddLines(const Camera& camera, std::vector<SpaceLine>& lines) const;
  /// Of the newest Update: what casts shadows.
  const skin::Capsules& capsules() const { return capsules_; }

 private:
  void Load(const PersonModel& model);
  void Move(const PersonState& person);
  using Level = std::pair<double, SkinShading>;  // error, m
  void AddLevel(const Level& level);
  void FindRegions();
  static void ShowLoads(const std::vector<JointLoad>& loads, ShadedActor& shaded);

  const Pass pass_;
  bool is_visible_ = true;
  std::shared_ptr<const PersonModel> model_;  // the loaded one
  std::uint64_t revision_ = 0;
  std::shared_ptr<const skin::SkinTemplate> own_;  // null: the built-in one
  std::unique_ptr<skin::PersonSkin> skin_;
  skin::PersonSkin::Surface surface_;
  std::vector<skin::LimbRun> limbs_;
  std::vector<float> open_;
  skin::Capsules capsules_;
  skin::Build build_;
  std::vector<skin::Borders> suit_;                               // of the built-in skin
  vtkNew<vtkFloatArray> positions_, normals_, paint_, open_sky_;  // paint: borders or colours
  vtkNew<vtkFloatArray> regions_;                                 // empty until loads are shown
  std::vector<urdf::Pose> shown_;                                 // the poses of `surface_`
  std::map<Level, std::unique_ptr<ShadedActor>> levels_;          // all share the vertices
};

}  // namespace kinescope::render
