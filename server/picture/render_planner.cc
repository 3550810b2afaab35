#include "server/picture/render_planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "render/legend_place.h"
#include "render/multi_view.h"
#include "render/overlay_free_area.h"

namespace kinescope::app {
namespace {

constexpr double kWindowSecs = 10;  // of a plot without a prescan

std::vector<CameraController> CamerasOf(const ViewOptions& options, const ViewGrid& grid, Fit fit) {
  const CameraChoice& given = options.camera->front();
  // One distance for all moments, as in a clip.
  if (grid.has_times()) return {CameraController(given, options.moves, Fit::kClip)};
  if (grid.cameras.empty()) return {CameraController(given, options.moves, fit)};
  std::vector<CameraController> cameras;
  for (const std::string& camera : grid.cameras) {
    cameras.emplace_back(camera == "camera" ? given : ParseCamera(camera), options.moves, fit);
  }
  return cameras;
}

std::vector<std::string> NamesOfViews(const ViewGrid& grid,
                                      const std::vector<CameraController>& cameras) {
  std::vector<std::string> names;
  for (const double secs : grid.times) names.push_back(fmt::format("{} s", secs));
  if (grid.cameras.empty()) return names;
  for (const CameraController& camera : cameras) {
    names.push_back(camera.name());
    std::replace(names.back().begin(), names.back().end(), '_', ' ');
  }
  return names;
}

// Free in each of them.
render::FreeArea CommonArea(const std::vector<render::FreeArea>& areas) {
  render::FreeArea common;
  for (const render::FreeArea& area : areas) {
    common.free.top = std::max(common.free.top, area.free.top);
    common.free.bottom = std::min(common.free.bottom, area.free.bottom);
    common.corners.insert(common.corners.end(), area.corners.begin(), area.corners.end());
  }
  return common;
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
    : spec_(ToPictureSpec(options)),
      grid_(*options.views),
      curves_(options.plot->size()),
      cameras_(CamerasOf(options, grid_, fit)),
      additions_(std::move(additions)),
      loads_(*options.plot) {
  for (std::string& name : NamesOfViews(grid_, cameras_)) {
    spec_.panes.push_back({std::move(name), {}});
  }
  spec_.pane_columns = grid_.columns;
  prescans_legend_ = fit == Fit::kClip && spec_.overlays && spec_.parts.legend &&
                     spec_.legend != render::LegendPlace::kInside;
  LayoutFor({});  // throws if the views have no room
}

RenderPlanner::Layout RenderPlanner::LayoutFor(const render::LegendContent& legend) const {
  Layout layout{spec_, {}, {}};
  render::PlaceLegend(layout.spec, legend);
  const render::Tile scene = layout.spec.SceneTile();
  const std::vector<render::Tile> views =
      spec_.panes.empty()
          ? std::vector<render::Tile>{scene}
          : render::PaneTiles(scene, static_cast<int>(spec_.panes.size()), spec_.pane_columns);
  layout.free_areas = render::FreeAreasOf(layout.spec, views, curves_, legend);
  for (const render::Tile& view : views) {
    layout.aspects.push_back(static_cast<double>(view.width) / view.height);
  }
  if (!grid_.has_times()) return layout;
  // One camera for all: what one view shows, each has room for.
  layout.free_areas = {CommonArea(layout.free_areas)};
  layout.aspects = {*std::min_element(layout.aspects.begin(), layout.aspects.end())};
  return layout;
}

std::vector<CameraController> RenderPlanner::CamerasFor(const Layout& layout) const {
  std::vector<CameraController> cameras = cameras_;
  for (std::size_t i = 0; i < cameras.size(); ++i) cameras[i].SetFreeArea(layout.free_areas[i]);
  return cameras;
}

void RenderPlanner::CollectLegend(const SceneState& state) {
  if (!legend_.is_empty()) return legend_.Add(render::LegendOf(state, spec_.look));
  SceneState first = state;
  render::SceneLook look = spec_.look;
  additions_.AddNamesTo(first, look);
  legend_ = render::LegendOf(first, look);
}

bool RenderPlanner::needs_prescan() const {
  if (grid_.has_times()) return false;  // all of it is known when it is drawn
  return !loads_.is_empty() || prescans_legend_ ||
         std::any_of(cameras_.begin(), cameras_.end(),
                     [](const CameraController& c) { return c.needs_prescan(); });
}

void RenderPlanner::Prescan(const SceneState& state) {
  const std::vector<Ball> beside = additions_.BallsBeside(state);
  for (CameraController& camera : cameras_) camera.Prescan(state, beside);
  if (prescans_legend_) CollectLegend(state);
  const double secs = SecsSince(prescan_start_nanos_, state);
  if (!loads_.is_empty()) loads_.Add(state, secs);
}

RenderRequest RenderPlanner::With(Layout layout, SceneState state, render::SceneLook look,
                                  std::vector<render::Camera> cameras, double secs) const {
  RenderRequest request{std::move(state), cameras.front(), std::move(layout.spec), {}, {}};
  for (const CameraController& camera : cameras_) {
    if (request.heading_note.empty()) request.heading_note = camera.HeadingNote(request.state);
  }
  if (marks_at_) request.spec.marks = marks_at_(request.state);
  request.spec.look = std::move(look);
  for (std::size_t i = 0; i < request.spec.panes.size(); ++i) {
    request.spec.panes[i].camera = cameras[i];
  }
  request.spec.plot_secs = secs;
  return request;
}

RenderRequest RenderPlanner::Next(SceneState state) {
  const double secs = SecsSince(start_nanos_, state);
  additions_.Remember(state);
  if (!layout_) {
    if (legend_.is_empty()) CollectLegend(state);
    layout_ = LayoutFor(legend_);
    cameras_ = CamerasFor(*layout_);
  }
  const std::vector<Ball> beside = additions_.BallsBeside(state);
  std::vector<render::Camera> cameras;
  for (std::size_t i = 0; i < cameras_.size(); ++i) {
    cameras.push_back(cameras_[i].Aim(state, layout_->aspects[i], beside));
  }
  std::shared_ptr<const render::LoadCurves> curves;
  if (!loads_.is_empty()) {
    if (prescan_start_nanos_) {
      if (whole_ == nullptr) whole_ = std::make_shared<const render::LoadCurves>(loads_.All());
      curves = whole_;
    } else {
      loads_.Add(state, secs);
      curves = std::make_shared<const render::LoadCurves>(loads_.Last(kWindowSecs));
    }
  }
  render::SceneLook look = spec_.look;
  additions_.AddTo(state, look);
  RenderRequest request =
      With(*layout_, std::move(state), std::move(look), std::move(cameras), secs);
  request.spec.load_curves = std::move(curves);
  return request;
}

RenderRequest RenderPlanner::Only(const SceneState& state, double secs) const {
  if (grid_.has_times()) {
    throw UsageError("--views=time: needs a recording; there is only one moment to show");
  }
  const std::vector<Ball> beside = additions_.BallsBeside(state);
  PlotBuffer loads = loads_;
  if (!prescan_start_nanos_) loads.Add(state, secs);
  SceneAdditions additions = additions_;
  additions.Remember(state);
  SceneState shown = state;
  render::SceneLook look = spec_.look;
  additions.AddTo(shown, look);
  Layout layout = LayoutFor(render::LegendOf(shown, look));
  std::vector<render::Camera> cameras;
  const std::vector<CameraController> controllers = CamerasFor(layout);
  for (std::size_t i = 0; i < controllers.size(); ++i) {
    cameras.push_back(controllers[i].Only(state, secs, layout.aspects[i], beside));
  }
  RenderRequest request =
      With(std::move(layout), std::move(shown), std::move(look), std::move(cameras), secs);
  if (!loads.is_empty()) {
    request.spec.load_curves = std::make_shared<const render::LoadCurves>(loads.All());
  }
  return request;
}

void RenderPlanner::AddMoment(SceneState state) {
  KINESCOPE_CHECK(grid_.has_times() && moments_.size() < grid_.times.size());
  Moment moment{{}, spec_.look, additions_.BallsBeside(state)};
  cameras_.front().Prescan(state, moment.beside);
  SceneAdditions additions = additions_;
  additions.Remember(state);
  moment.state = std::move(state);
  additions.AddTo(moment.state, moment.look);
  moments_.push_back(std::move(moment));
}

RenderRequest RenderPlanner::Moments() const {
  const std::vector<double> times = moment_times();
  KINESCOPE_CHECK(!times.empty() && moments_.size() == times.size());
  render::LegendContent legend;
  for (const Moment& moment : moments_) legend.Add(render::LegendOf(moment.state, moment.look));
  Layout layout = LayoutFor(legend);
  layout.spec.legend_content = std::make_shared<const render::LegendContent>(legend);
  CameraController camera = CamerasFor(layout).front();
  std::vector<render::Pane> panes;  // by time
  for (const Moment& moment : moments_) {
    const auto& [state, look, beside] = moment;
    panes.push_back({"", camera.Aim(state, layout.aspects.front(), beside),
                     std::make_shared<const render::PaneScene>(
                         render::PaneScene{state, look.trails, look.ghosts})});
  }
  std::vector<render::Camera> cameras;
  for (std::size_t i = 0; i < grid_.times.size(); ++i) {
    const auto at = std::lower_bound(times.begin(), times.end(), grid_.times[i]) - times.begin();
    const render::Pane& pane = panes[static_cast<std::size_t>(at)];
    cameras.push_back(pane.camera);
    layout.spec.panes[i].scene = pane.scene;
  }
  const std::shared_ptr<const render::PaneScene> first = layout.spec.panes.front().scene;
  render::SceneLook look = spec_.look;
  return With(std::move(layout), first->state, std::move(look), std::move(cameras), 0);
}

void PrescanClip(const std::vector<RenderPlanner*>& planners, SceneReader& source,
                 std::optional<double> seconds, const std::function<void()>& on_scene) {
  std::optional<std::int64_t> start_nanos;
  while (const auto state = source.Next()) {
    if (StopRequested()) return;
    const double secs = SecsSince(start_nanos, *state);
    if (seconds && secs > *seconds) return;
    for (RenderPlanner* planner : planners) planner->Prescan(*state);
    on_scene();
  }
}

void RememberBefore(double secs, SceneTimeline& timeline, RenderPlanner& planner, double after) {
  constexpr int kPerSecond = 60;
  const int steps = static_cast<int>(std::min(secs, planner.history_secs()) * kPerSecond);
  for (int step = steps; step > 0; --step) {
    const double at = secs - static_cast<double>(step) / kPerSecond;
    if (at < after) continue;
    const auto scene = timeline.At(at);
    if (scene) planner.Remember(*scene);
  }
}

}  // namespace kinescope::app
