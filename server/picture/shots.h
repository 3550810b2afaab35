/// From scenes to pictures of a recording: what depends on other scenes (a camera that follows, a
/// plot of loads) is decided here, one scene after the other, so that the pictures themselves can
/// be drawn in any order and by any number of renderers. A planner belongs to one thread; a Shot is
/// a value that goes to any.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "core/scene_state.h"
#include "render/camera.h"
#include "render/renderer.h"
#include "server/picture/camera_man.h"
#include "server/picture/load_window.h"
#include "server/picture/scene_extras.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {

/// All that one picture depends on. Several views: the cameras are in view.panes, `camera` is the
/// first of them.
struct Shot {
  SceneState state;
  render::Camera camera;
  render::View view;
  std::optional<render::LayerFormat> layer;  // what is written over it, as vectors too
};

class ShotPlanner {
 public:
  /// `people`: those of the scenes to come. @throws UsageError for what `options` ask for that
  /// there is not.
  explicit ShotPlanner(const ViewOptions& options, const BackendOptions& backend = {},
                       const SceneOptions& people = {});
  /// With `extras` that several planners share: files are read and robots measured once.
  ShotPlanner(const ViewOptions& options, SceneExtras extras);

  /// Whether the whole clip must be known before its first picture: one turn over it, a frame
  /// around all of it, a plot of all of it. Without a survey they do with what there is: no turn,
  /// no frame, a plot of the newest seconds.
  bool needs_survey() const;
  /// Every scene of the clip, in order, before the first shot.
  void Survey(const SceneState& state);

  /// Of a clip: the scenes in order.
  Shot Next(SceneState state);

  /// Of one scene alone, `secs` after the recording's start. Trails are those of the scenes that
  /// were remembered before.
  Shot Only(SceneState state, double secs = 0) const;

  /// A scene that comes before the first picture; in order. Of use where history_secs() > 0.
  void Remember(const SceneState& state) { extras_.Remember(state); }
  /// How much of what was before it a picture shows, s.
  double history_secs() const { return extras_.history_secs(); }

  const render::View& view() const { return view_; }

 private:
  Shot With(SceneState state, std::vector<render::Camera> cameras, double secs,
            const SceneExtras& extras) const;

  render::View view_;
  std::vector<CameraMan> cameras_;  // one, or one for each view
  std::vector<double> aspects_;     // of their pictures
  SceneExtras extras_;
  LoadWindow loads_;  // of the survey, or else of the scenes so far
  std::optional<std::int64_t> start_nanos_, survey_start_nanos_;
  std::shared_ptr<const render::LoadHistory> whole_;  // of the survey, made with the first shot
};

/// Surveys what `source` has for `planners`, up to `seconds` after its first scene. For planners
/// that need it.
/// @throws as SceneReader.
void SurveyClip(const std::vector<ShotPlanner*>& planners, SceneReader& source,
                std::optional<double> seconds);

/// Shows `planner` what a picture at `secs` needs of the time before. @pre as SceneTimeline::At
void RememberBefore(double secs, SceneTimeline& timeline, ShotPlanner& planner);

}  // namespace kinescope::app
