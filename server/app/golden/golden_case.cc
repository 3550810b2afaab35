#include "server/app/golden/golden_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "render/multi_view.h"
#include "server/options/option_list.h"
#include "server/picture/shots.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

Liveness ToLiveness(const fs::path& path, const std::string& text) {
  for (const Liveness liveness : {Liveness::kLive, Liveness::kStale, Liveness::kNoData}) {
    if (text == Name(liveness)) return liveness;
  }
  throw UsageError(
      fmt::format("{}: state: {}: expected live, stale or no data", path.string(), text));
}

constexpr double kSurveySecs = 5;  // of a source that may have no end

SceneState SceneOf(const GoldenCase& golden_case, const SceneOptions& options,
                   ShotPlanner& planner) {
  SceneReader reader(golden_case.source, options);
  if (golden_case.show == Liveness::kNoData) return *reader.Empty();
  SceneTimeline timeline(reader);
  RememberBefore(golden_case.time_secs, timeline, planner);
  std::optional<SceneState> scene = timeline.At(golden_case.time_secs);
  if (!scene) {
    throw UsageError(fmt::format("golden case {}: {} ends before {} s", golden_case.name,
                                 golden_case.source, golden_case.time_secs));
  }
  return golden_case.show == Liveness::kStale ? *reader.Stale() : *scene;
}

std::vector<render::SphereInPicture> SpheresOf(const Shot& shot) {
  const render::View& view = shot.view;
  const SceneState shown = render::Without(shot.state, view.look);
  if (view.panes.empty()) {
    return render::LocateSpheres(shown, shot.camera, view.width, view.height);
  }
  std::vector<render::SphereInPicture> all;
  const auto tiles = render::PaneTiles(view.width, view.height, static_cast<int>(view.panes.size()),
                                       view.pane_columns);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const render::Tile& tile = tiles[i];
    const render::Pane& pane = view.panes[i];
    for (render::SphereInPicture& sphere :
         render::LocateSpheres(shown, pane.camera, tile.width, tile.height)) {
      const double r = sphere.radius_px;
      if (sphere.x_px < r || sphere.x_px > tile.width - r || sphere.y_px < r ||
          sphere.y_px > tile.height - r) {
        continue;
      }
      sphere.joint = pane.name + "/" + sphere.joint;
      sphere.x_px += tile.x;
      sphere.y_px += tile.y;
      all.push_back(std::move(sphere));
    }
  }
  return all;
}

}  // namespace

GoldenCase LoadGoldenCase(const fs::path& yaml) {
  GoldenCase golden_case;
  golden_case.name = golden_case.view.title = yaml.stem();
  golden_case.view.size = "640x360";
  std::string show = Name(Liveness::kLive);
  const YamlValues values(yaml.string());
  ValueSetter read(values);
  read("source", golden_case.source);
  read("time", golden_case.time_secs);
  read("state", show);
  read("why", golden_case.why);
  golden_case.view.Visit(read);
  golden_case.person.Visit(read);
  golden_case.loads.Visit(read);
  values.RefuseUnknown(read.names());
  if (golden_case.source.empty()) throw UsageError(yaml.string() + ": source: is missing");
  if (golden_case.source.rfind("demo:", 0) != 0) {
    golden_case.source = (yaml.parent_path() / golden_case.source).string();
  }
  golden_case.show = ToLiveness(yaml, show);
  if (!(golden_case.time_secs >= 0 && golden_case.time_secs <= kLatestSecs)) {
    throw UsageError(fmt::format("{}: time: {}: expected 0 to {:.0f} s", yaml.string(),
                                 golden_case.time_secs, kLatestSecs));
  }
  return golden_case;
}

std::vector<GoldenCase> LoadGoldenCases(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  if (error) throw UsageError(fmt::format("folder '{}': {}", folder.string(), error.message()));
  if (files.empty())
    throw UsageError(fmt::format("folder '{}' holds no case (*.yaml)", folder.string()));
  std::sort(files.begin(), files.end());
  std::vector<GoldenCase> cases;
  cases.reserve(files.size());
  for (const fs::path& file : files) cases.push_back(LoadGoldenCase(file));
  return cases;
}

GoldenDrawing Draw(const GoldenCase& golden_case, render::Renderer& renderer) {
  const SceneOptions options =
      ToSceneOptions(golden_case.person, SceneOptions().stale_secs, golden_case.loads);
  ShotPlanner planner(golden_case.view, {}, options);
  if (planner.needs_survey()) {
    SceneReader reader(golden_case.source, options);
    SurveyClip({&planner}, reader, kSurveySecs);
  }
  const Shot shot = planner.Only(SceneOf(golden_case, options, planner), golden_case.time_secs);
  GoldenDrawing drawing;
  drawing.image = renderer.Render(shot.state, shot.camera, shot.view);
  drawing.spheres = SpheresOf(shot);
  if (shot.view.overlays && shot.view.parts.strip && golden_case.show != Liveness::kNoData) {
    drawing.strip = {shot.state.counter, shot.state.time_code_millis};
  }
  return drawing;
}

}  // namespace kinescope::app
