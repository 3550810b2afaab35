#include "server/picture/render_planner.h"

#include <algorithm>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/stop_signal.h"
#include "render/multi_view.h"
#include "render/overlay_free_area.h"

namespace kinescope::app {
namespace {

constexpr double kWindowSecs = 10;  // of a plot without a prescan

std::vector<CameraController> CamerasOf(const ViewOptions& options, const ViewGrid& grid, Fit fit) {
  const CameraChoice& given = options.camera->front();
  if (grid.cameras.empty()) return {CameraController(given, options.moves, fit)};
  std::vector<CameraController> cameras;
  for (const std::string& camera : grid.cameras) {
    cameras.emplace_back(camera == "camera" ? given : ParseCamera(camera), options.moves, fit);
  }
  return cameras;
}

double SecsSince(std::optional<std::int64_t>& start_nanos, const SceneState& state) {
  if (!start_nanos) start_nanos = state.stamp_nanos;
  return Secs(state.stamp_nanos - *start_nanos);
}

}  // namespace

RenderPlanner::RenderPlanner(const ViewOptions& options, const BackendOptions& backend,
                             const SceneOptions& people)
    : RenderPlanner(options, SceneAdditions(options, backend, people)) {}

RenderPlanner::RenderPlanner(const ViewOptions& options, SceneAdditions additions, Fit fit)
    : spec_(ToPictureSpec(options)), additions_(std::move(additions)), loads_(*options.plot) {
  const ViewGrid& grid = *options.views;
  cameras_ = CamerasOf(options, grid, fit);
  if (grid.cameras.empty()) {
    SetViews({{0, 0, spec_.width, spec_.height}}, options.plot->size());
    return;
  }
  spec_.pane_columns = grid.columns;
  for (const CameraController& camera : cameras_) {
    std::string name = camera.name();
    std::replace(name.begin(), name.end(), '_', ' ');
    spec_.panes.push_back({name, {}});
  }
  SetViews(render::PaneTiles(spec_.width, spec_.height, static_cast<int>(cameras_.size()),
                             spec_.pane_columns),
           options.plot->size());
}

void RenderPlanner::SetViews(const std::vector<render::Tile>& views, std::size_t curves) {
  const std::vector<render::FreeArea> areas = render::FreeAreasOf(spec_, views, curves);
  for (std::size_t i = 0; i < views.size(); ++i) {
    aspects_.push_back(static_cast<double>(views[i].width) / views[i].height);
    cameras_[i].SetFreeArea(areas[i]);
  }
}

bool RenderPlanner::needs_prescan() const {
  return !loads_.is_empty() ||
         std::any_of(cameras_.begin(), cameras_.end(),
                     [](const CameraController& c) { return c.needs_prescan(); });
}

void RenderPlanner::Prescan(const SceneState& state) {
  const std::vector<Ball> beside = additions_.BallsBeside(state);
  for (CameraController& camera : cameras_) camera.Prescan(state, beside);
  if (!loads_.is_empty()) loads_.Add(state, SecsSince(prescan_start_nanos_, state));
}

RenderRequest RenderPlanner::With(SceneState state, std::vector<render::Camera> cameras,
                                  double secs, const SceneAdditions& additions) const {
  RenderRequest request{std::move(state), cameras.front(), spec_, {}};
  additions.AddTo(request.state, request.spec.look);
  for (std::size_t i = 0; i < request.spec.panes.size(); ++i) {
    request.spec.panes[i].camera = cameras[i];
  }
  request.spec.plot_secs = secs;
  return request;
}

RenderRequest RenderPlanner::Next(SceneState state) {
  const double secs = SecsSince(start_nanos_, state);
  additions_.Remember(state);
  const std::vector<Ball> beside = additions_.BallsBeside(state);
  std::vector<render::Camera> cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras.push_back(cameras_[i].Aim(state, aspects_[i], beside));
  }
  if (loads_.is_empty()) return With(std::move(state), std::move(cameras), secs, additions_);
  std::shared_ptr<const render::LoadCurves> curves;
  if (prescan_start_nanos_) {
    if (whole_ == nullptr) whole_ = std::make_shared<const render::LoadCurves>(loads_.All());
    curves = whole_;
  } else {
    loads_.Add(state, secs);
    curves = std::make_shared<const render::LoadCurves>(loads_.Last(kWindowSecs));
  }
  RenderRequest request = With(std::move(state), std::move(cameras), secs, additions_);
  request.spec.load_curves = std::move(curves);
  return request;
}

RenderRequest RenderPlanner::Only(SceneState state, double secs) const {
  const std::vector<Ball> beside = additions_.BallsBeside(state);
  std::vector<render::Camera> cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras.push_back(cameras_[i].Only(state, secs, aspects_[i], beside));
  }
  PlotBuffer loads = loads_;
  if (!prescan_start_nanos_) loads.Add(state, secs);
  SceneAdditions additions = additions_;
  additions.Remember(state);
  RenderRequest request = With(std::move(state), std::move(cameras), secs, additions);
  if (!loads.is_empty()) {
    request.spec.load_curves = std::make_shared<const render::LoadCurves>(loads.All());
  }
  return request;
}

void PrescanClip(const std::vector<RenderPlanner*>& planners, SceneReader& source,
                 std::optional<double> seconds) {
  std::optional<std::int64_t> start_nanos;
  while (const auto state = source.Next()) {
    if (StopRequested()) return;
    const double secs = SecsSince(start_nanos, *state);
    if (seconds && secs > *seconds) return;
    for (RenderPlanner* planner : planners) planner->Prescan(*state);
  }
}

void RememberBefore(double secs, SceneTimeline& timeline, RenderPlanner& planner) {
  constexpr int kPerSecond = 60;
  const int steps = static_cast<int>(std::min(secs, planner.history_secs()) * kPerSecond);
  for (int step = steps; step > 0; --step) {
    const auto scene = timeline.At(secs - static_cast<double>(step) / kPerSecond);
    if (scene) planner.Remember(*scene);
  }
}

}  // namespace kinescope::app
