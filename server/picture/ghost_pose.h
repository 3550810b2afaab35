/// The pose that a picture shows as a ghost, to compare with: of the anatomical positions, or a
/// moment of a recording. Read once, by the constructor; then any thread may ask.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/scene_look.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class GhostPose {
 public:
  /// `text`: "" (none), "n_pose", "t_pose" or FILE@SECS. `opacity` 0..1. `options`: how the people
  /// of a recording look, as those of the picture do. Ctrl-C ends the reading of one.
  /// @throws UsageError; SourceError for a recording that cannot be read; std::runtime_error when
  /// interrupted.
  GhostPose(const std::string& text, double opacity, const SceneOptions& options);

  /// n_pose and t_pose: of every person in `state`, with their own lengths, where their pelvis is,
  /// facing as it does, soles on the floor. FILE@SECS: whoever is there then, where they were.
  std::vector<render::Ghost> Make(const SceneState& state) const;

 private:
  enum class Kind { kNone, kNPose, kTPose, kMoment };
  Kind kind_ = Kind::kNone;
  double opacity_;
  std::vector<PersonState> recorded_;
};

}  // namespace kinescope::app
