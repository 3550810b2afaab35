/// Renders what one camera sees, for all outputs of that camera. The thread that reads the source
/// calls these classes.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "server/app/progress.h"
#include "server/app/render/draw_pool.h"
#include "server/app/render/output_writer.h"
#include "server/app/render/resume_check.h"
#include "server/picture/render_planner.h"

namespace kinescope::app {

/// One picture. It does not follow what a clip of the same camera does before it.
class StillTask {
 public:
  /// `layer`: the format of its overlays as a vector file, if there is one.
  StillTask(RenderPlanner planner, std::optional<render::LayerFormat> layer)
      : planner_(std::move(planner)), layer_(layer) {}

  void AddOutput(OutputWriter& writer) { writers_.push_back(&writer); }
  bool HasOutputs() const { return !writers_.empty(); }
  RenderPlanner& planner() { return planner_; }

  /// A scene before the picture; in order. The trails need it.
  void Remember(const SceneState& scene);

  /// `secs` after the start of the recording. Holds no picture when it returns: the pool may have
  /// room for one alone.
  void Draw(const SceneState& scene, double secs, DrawPool& pool, Progress& progress);

  /// The picture of all moments that RenderPlanner::AddMoment got.
  void DrawMoments(DrawPool& pool, Progress& progress);

 private:
  void Draw(RenderRequest request, DrawPool& pool, Progress& progress);

  RenderPlanner planner_;
  std::optional<render::LayerFormat> layer_;
  std::vector<OutputWriter*> writers_;
};

/// The pictures of clips and sequences.
class ClipTask {
 public:
  explicit ClipTask(RenderPlanner planner) : planner_(std::move(planner)) {}

  void AddOutput(OutputWriter& writer) { writers_.push_back(&writer); }
  bool HasOutputs() const { return !writers_.empty(); }
  RenderPlanner& planner() { return planner_; }

  /// Picture `k`, for the outputs that `check` wants it for. Call it for every picture, in order:
  /// the camera also follows the people through pictures that are up to date.
  void Draw(long k, const SceneState& scene, const ResumeCheck& check, DrawPool& pool,
            Progress& progress);

 private:
  RenderPlanner planner_;
  std::vector<OutputWriter*> writers_;
};

}  // namespace kinescope::app
