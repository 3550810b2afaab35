#include "server/app/render/render_tasks.h"

#include <cstdint>

namespace kinescope::app {

void StillTask::Remember(const SceneState& scene) {
  if (planner_.history_secs() > 0) planner_.Remember(scene);
}

void StillTask::Draw(const SceneState& scene, double secs, DrawPool& pool, Progress& progress) {
  Draw(planner_.Only(scene, secs), pool, progress);
}

void StillTask::DrawMoments(DrawPool& pool, Progress& progress) {
  Draw(planner_.Moments(), pool, progress);
}

void StillTask::Draw(RenderRequest request, DrawPool& pool, Progress& progress) {
  request.layer = layer_;
  const render::Camera camera = request.camera;
  const std::uint32_t counter = request.state.counter;
  const std::string note = request.heading_note;
  const FuturePicture picture = pool.Draw(std::move(request));
  for (OutputWriter* const writer : writers_) {
    writer->SetCounter(counter);
    writer->Put(0, picture, camera, note);
    progress.Step();
  }
}

void ClipTask::Draw(long k, const SceneState& scene, const ResumeCheck& check, DrawPool& pool,
                    Progress& progress) {
  RenderRequest request = planner_.Next(scene);
  std::vector<OutputWriter*> takers;
  for (OutputWriter* const writer : writers_) {
    if (check.Wants(writer->output(), k)) takers.push_back(writer);
  }
  if (takers.empty()) return progress.Skip();
  const render::Camera camera = request.camera;
  const std::string note = request.heading_note;
  const FuturePicture picture = pool.Draw(std::move(request));
  for (OutputWriter* const taker : takers) taker->Put(k, picture, camera, note);
  progress.Step();
}

}  // namespace kinescope::app
