#include "server/picture/shots.h"

#include <algorithm>
#include <utility>

#include "core/clocks.h"
#include "core/stop_signal.h"
#include "render/multi_view.h"

namespace kinescope::app {
namespace {

constexpr double kWindowSecs = 10;  // of a plot without a survey

std::vector<CameraController> CamerasOf(const ViewOptions& options, const ViewGrid& grid) {
  const CameraChoice& given = options.camera->front();
  if (grid.cameras.empty()) return {CameraController(given, options.moves)};
  std::vector<CameraController> cameras;
  for (const std::string& camera : grid.cameras) {
    cameras.emplace_back(camera == "camera" ? given : ParseCamera(camera), options.moves);
  }
  return cameras;
}

double SecsSince(std::optional<std::int64_t>& start_nanos, const SceneState& state) {
  if (!start_nanos) start_nanos = state.stamp_nanos;
  return Secs(state.stamp_nanos - *start_nanos);
}

}  // namespace

ShotPlanner::ShotPlanner(const ViewOptions& options, const BackendOptions& backend,
                         const SceneOptions& people)
    : ShotPlanner(options, SceneAdditions(options, backend, people)) {}

ShotPlanner::ShotPlanner(const ViewOptions& options, SceneAdditions additions)
    : view_(ToView(options)), additions_(std::move(additions)), loads_(*options.plot) {
  const ViewGrid& grid = *options.views;
  cameras_ = CamerasOf(options, grid);
  if (grid.cameras.empty()) {
    aspects_ = {static_cast<double>(view_.width) / view_.height};
    return;
  }
  view_.pane_columns = grid.columns;
  for (const CameraController& camera : cameras_) {
    std::string name = camera.name();
    std::replace(name.begin(), name.end(), '_', ' ');
    view_.panes.push_back({name, {}});
  }
  for (const render::Tile& tile : render::PaneTiles(
           view_.width, view_.height, static_cast<int>(cameras_.size()), view_.pane_columns)) {
    aspects_.push_back(static_cast<double>(tile.width) / tile.height);
  }
}

bool ShotPlanner::needs_survey() const {
  return !loads_.is_empty() ||
         std::any_of(cameras_.begin(), cameras_.end(),
                     [](const CameraController& c) { return c.needs_survey(); });
}

void ShotPlanner::Survey(const SceneState& state) {
  for (CameraController& camera : cameras_) camera.Survey(state);
  if (!loads_.is_empty()) loads_.Add(state, SecsSince(survey_start_nanos_, state));
}

Shot ShotPlanner::With(SceneState state, std::vector<render::Camera> cameras, double secs,
                       const SceneAdditions& additions) const {
  Shot shot{std::move(state), cameras.front(), view_, {}};
  additions.AddTo(shot.state, shot.view.look);
  for (std::size_t i = 0; i < shot.view.panes.size(); ++i) {
    shot.view.panes[i].camera = cameras[i];
  }
  shot.view.plot_secs = secs;
  return shot;
}

Shot ShotPlanner::Next(SceneState state) {
  const double secs = SecsSince(start_nanos_, state);
  additions_.Remember(state);
  std::vector<render::Camera> cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras.push_back(cameras_[i].Aim(state, aspects_[i]));
  }
  if (loads_.is_empty()) return With(std::move(state), std::move(cameras), secs, additions_);
  std::shared_ptr<const render::LoadHistory> history;
  if (survey_start_nanos_) {
    if (whole_ == nullptr) whole_ = std::make_shared<const render::LoadHistory>(loads_.All());
    history = whole_;
  } else {
    loads_.Add(state, secs);
    history = std::make_shared<const render::LoadHistory>(loads_.Last(kWindowSecs));
  }
  Shot shot = With(std::move(state), std::move(cameras), secs, additions_);
  shot.view.history = std::move(history);
  return shot;
}

Shot ShotPlanner::Only(SceneState state, double secs) const {
  std::vector<render::Camera> cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras.push_back(cameras_[i].Only(state, secs, aspects_[i]));
  }
  LoadWindow loads = loads_;
  if (!survey_start_nanos_) loads.Add(state, secs);
  SceneAdditions additions = additions_;
  additions.Remember(state);
  Shot shot = With(std::move(state), std::move(cameras), secs, additions);
  if (!loads.is_empty()) {
    shot.view.history = std::make_shared<const render::LoadHistory>(loads.All());
  }
  return shot;
}

void SurveyClip(const std::vector<ShotPlanner*>& planners, SceneReader& source,
                std::optional<double> seconds) {
  std::optional<std::int64_t> start_nanos;
  while (const auto state = source.Next()) {
    if (StopRequested()) return;
    const double secs = SecsSince(start_nanos, *state);
    if (seconds && secs > *seconds) return;
    for (ShotPlanner* planner : planners) planner->Survey(*state);
  }
}

void RememberBefore(double secs, SceneTimeline& timeline, ShotPlanner& planner) {
  constexpr int kPerSecond = 60;
  const int steps = static_cast<int>(std::min(secs, planner.history_secs()) * kPerSecond);
  for (int step = steps; step > 0; --step) {
    const auto scene = timeline.At(secs - static_cast<double>(step) / kPerSecond);
    if (scene) planner.Remember(*scene);
  }
}

}  // namespace kinescope::app
