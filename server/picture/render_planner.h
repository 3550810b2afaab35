/// Plans the pictures of a recording. Everything that depends on other scenes (a camera that
/// follows, a plot of loads) is computed here, one scene after the other, so that any number of
/// renderers can render the pictures in any order. A planner belongs to one thread; a RenderRequest
/// is a value for any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/camera/framing.h"
#include "render/legend.h"
#include "render/renderer.h"
#include "render/scene_look.h"
#include "server/picture/camera_controller.h"
#include "server/picture/plot_buffer.h"
#include "server/picture/scene_additions.h"
#include "server/picture/view_options.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {

/// Everything that one picture depends on. With several views, the cameras are in spec.panes, and
/// `camera` is the first of them; with several moments, `state` is the first view's.
struct RenderRequest {
  SceneState state;
  render::Camera camera;
  render::PictureSpec spec;
  std::optional<render::LayerFormat> layer;  // format for its overlays as a vector file, if
                                             // requested
  std::string heading_note;                  // CameraController::HeadingNote, of the first picture
};

class RenderPlanner {
 public:
  /// `people`: options of the people in the scenes. @throws UsageError for invalid or impossible
  /// options.
  explicit RenderPlanner(const ViewOptions& options, const BackendOptions& backend = {},
                         const SceneOptions& people = {});
  /// With `additions` shared by several planners, so that files are read and robots measured once.
  /// `fit`: what --fit=auto means; Fit::kClip: of a clip that can be read twice.
  RenderPlanner(const ViewOptions& options, SceneAdditions additions, Fit fit = Fit::kNow);

  /// Whether the first picture requires the whole clip: one revolution over the clip, a frame
  /// around all of it, a plot of all of it, a legend beside all of it. Without a first pass they
  /// use the available data: no revolution, no frame, a plot of the newest seconds, a legend of the
  /// first picture.
  bool needs_prescan() const;
  /// First pass: call it for every scene of the clip, in order, before the first request.
  void Prescan(const SceneState& state);

  /// The next picture of a clip; call it with the scenes in order.
  RenderRequest Next(SceneState state);

  /// A single picture, `secs` after the start of the recording. Trails are those of the scenes
  /// passed to Remember before.
  RenderRequest Only(const SceneState& state, double secs = 0) const;

  /// The times that ViewsValue names, s after the first sample, each once, in ascending order;
  /// empty without.
  std::vector<double> moment_times() const { return grid_.TimesInOrder(); }
  /// The scene at the next of these times. Then Moments() is the picture of all of them.
  void AddMoment(SceneState state);
  RenderRequest Moments() const;

  /// Adds a scene before the first picture; in order. Needed if history_secs() > 0.
  void Remember(const SceneState& state) { additions_.Remember(state); }
  /// Length of the history that a picture shows, s.
  double history_secs() const { return additions_.history_secs(); }

  /// What was marked at the time of a state: captions for the overlay.
  void ShowMarks(std::function<std::vector<std::string>(const SceneState&)> marks_at) {
    marks_at_ = std::move(marks_at);
  }

  const render::PictureSpec& spec() const { return spec_; }

 private:
  // The places of scene, views and legend.
  struct Layout {
    render::PictureSpec spec;
    std::vector<double> aspects;  // of the views, width / height
    std::vector<render::FreeArea> free_areas;
  };
  struct Moment {
    SceneState state;
    render::SceneLook look;
    std::vector<Ball> beside;
  };

  Layout LayoutFor(const render::LegendContent& legend) const;
  std::vector<CameraController> CamerasFor(const Layout& layout) const;
  void CollectLegend(const SceneState& state);
  RenderRequest With(Layout layout, SceneState state, render::SceneLook look,
                     std::vector<render::Camera> cameras, double secs) const;

  render::PictureSpec spec_;  // its views have no cameras yet
  ViewGrid grid_;
  std::size_t curves_;                     // of the plot
  std::vector<CameraController> cameras_;  // one, or one per view
  SceneAdditions additions_;
  PlotBuffer loads_;  // of the first pass, or else of the scenes so far
  std::optional<std::int64_t> start_nanos_, prescan_start_nanos_;
  // Of the first pass, made with the first request.
  std::shared_ptr<const render::LoadCurves> whole_;
  bool prescans_legend_ = false;
  render::LegendContent legend_;  // of the first pass, or else of the first picture
  std::optional<Layout> layout_;  // of a clip, made with the first request
  std::vector<Moment> moments_;
  std::function<std::vector<std::string>(const SceneState&)> marks_at_;  // null: none
};

/// Performs the first pass for `planners` that need it: reads `source` up to `seconds` after its
/// first scene. `on_scene` is called after each one.
/// @throws as SceneReader.
void PrescanClip(
    const std::vector<RenderPlanner*>& planners, SceneReader& source, std::optional<double> seconds,
    const std::function<void()>& on_scene = [] {});

/// Passes to `planner` the history that a picture at `secs` needs. @pre as SceneTimeline::At
/// `after`: s, up to where it has it already.
void RememberBefore(double secs, SceneTimeline& timeline, RenderPlanner& planner, double after = 0);

}  // namespace kinescope::app
