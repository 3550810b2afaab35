/// The pose that a picture shows as a ghost, to compare with: of the anatomical positions, or a
/// moment of a recording. Read once, by the constructor; then any thread may ask.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"
#include "render/scene_look.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_builder.h"

namespace kinescope::app {

class GhostPose {
 public:
  /// `opacity` 0..1. `options`: how the people of a recording look, as those of the picture do.
  /// Ctrl-C ends the reading of one.
  /// @throws UsageError when the recording has no person at that time; SourceError when it cannot
  /// be read; std::runtime_error when interrupted.
  GhostPose(const GhostValue& ghost, double opacity, const SceneOptions& options);

  /// n_pose and t_pose: of every person in `state`, with their own lengths, where their pelvis is,
  /// facing as it does, soles on the floor. FILE@SECS: the people at that time, at their recorded
  /// positions.
  std::vector<Ghost> Make(const SceneState& state) const;

 private:
  GhostSource::Kind kind_;
  double opacity_;
  std::string name_;  // for legends
  std::vector<PersonState> recorded_;
};

}  // namespace kinescope::app
