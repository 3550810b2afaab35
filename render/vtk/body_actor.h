/// Renders a person's body: as one skin with what is worn and held, or the visuals of every visible
/// link, fingers and props included. A new pose changes matrices and the skin; a new model changes
/// the meshes.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/picture_region.h"
#include "render/module.h"
#include "render/once_log.h"
#include "render/scene_look.h"
#include "render/shape/visual_mesh.h"
#include "render/vtk/part_actor.h"
#include "render/vtk/skin_actor.h"

namespace kinescope::render {

class BodyActor {
 public:
  explicit BodyActor(Pass pass = Pass::kSolid) : pass_(pass), skin_(pass) {}

  /// How far the drawn surface may be from the model's, m; 0: not at all.
  struct Error {
    double parts = 0;  // of the URDF; also lit at the vertices then
    double skin = 0;
    bool is_far = false;  // the skin's triangles are a few pixels wide
  };

  struct Look {
    Figure figure = Figure::kSkin;
    bool has_loads = false;  // on the skin
    bool is_flat = false;    // the skin is drawn without light
  };

  /// Adds the names of missing meshes to `labels`. `override_color`: see PartActor.
  /// @return whether the list of actors has changed.
  bool Update(const PersonState& person, const Look& look, const Eigen::Vector4f& override_color,
              const Error& error, OnceLog& log, std::vector<Label>& labels);

  /// Meshes that are replaced by boxes.
  const std::vector<std::string>& problems() const { return problems_; }
  std::vector<vtkActor*> actors();
  /// Those of the newest Update as a skin; null: it was none.
  const skin::Capsules* limbs() const { return is_skin_ ? &skin_.capsules() : nullptr; }
  /// Those of the newest Update as a skin.
  void AddLines(const Camera& camera, std::vector<SpaceLine>& lines) const {
    if (is_skin_) skin_.AddLines(camera, lines);
  }
  /// Of the newest Update, if it is visible.
  void AddTo(PictureRegion& region) const;
  /// Takes effect with the next Update.
  void SetVisible(bool is_visible) { is_visible_ = is_visible; }
  /// 0..1; takes effect with the next Update.
  void SetOpacity(double opacity) { opacity_ = opacity; }

 private:
  // The links of one draw call.
  struct Group {
    VisualMesh mesh;        // without triangles if they were too many to keep
    bool is_fixed = false;  // has one actor, for all errors
    std::map<double, std::unique_ptr<PartActor>> actors;  // by their error, m, made when needed;
                                                          // one of them is visible
    std::size_t first = 0, count = 0;                     // of VisibleLinks
  };
  void Load(const PersonModel& model, bool is_skin, OnceLog& log);
  void AddActor(double error_m, Group& group) const;
  void Show(PartActor& actor, const Group& group, const std::vector<urdf::Pose>& poses,
            const Eigen::Vector4f& override_color);

  const Pass pass_;
  double opacity_ = 1;
  std::vector<Group> groups_;
  std::shared_ptr<const PersonModel> model_;  // the loaded model; held, so that its address is not
                                              // reused
  std::uint64_t revision_ = 0;
  bool is_skin_ = false;  // else all visuals are in the groups
  SkinActor skin_;
  bool is_visible_ = true;
  std::vector<std::string> problems_;
};

}  // namespace kinescope::render
