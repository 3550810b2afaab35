#include "server/app/golden/golden_case.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "core/system/errors.h"
#include "render/multi_view.h"
#include "server/options/yaml_options.h"
#include "server/picture/render_planner.h"
#include "server/scene/scene_reader.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

options::PixelSize PixelSizeOfCases() { return {640, 360}; }

SceneState SceneOf(const GoldenCase& golden_case, const SceneOptions& options,
                   RenderPlanner& planner) {
  CheckReach(fmt::format("golden case {}: time: {}", golden_case.name, *golden_case.time),
             *golden_case.time, *golden_case.source);
  SceneReader reader(*golden_case.source, options);
  if (*golden_case.state == Liveness::kNoData) return *reader.Empty();
  SceneTimeline timeline(reader);
  RememberBefore(*golden_case.time, timeline, planner);
  std::optional<SceneState> scene = timeline.At(*golden_case.time);
  if (!scene) {
    throw UsageError(
        fmt::format("golden case {}: source {} ends before {} s; choose an earlier time",
                    golden_case.name, *golden_case.source, *golden_case.time));
  }
  return *golden_case.state == Liveness::kStale ? *reader.Stale() : *scene;
}

std::vector<render::SphereInPicture> SpheresOf(const RenderRequest& request) {
  const render::PictureSpec& spec = request.spec;
  const SceneState shown = render::Without(request.state, spec.look);
  if (spec.panes.empty()) {
    return render::LocateSpheres(shown, request.camera, spec.width, spec.height);
  }
  std::vector<render::SphereInPicture> all;
  const auto tiles = render::PaneTiles(spec.width, spec.height, static_cast<int>(spec.panes.size()),
                                       spec.pane_columns);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const render::Tile& tile = tiles[i];
    const render::Pane& pane = spec.panes[i];
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

GoldenCase::GoldenCase()
    : time(0, {0, kLatestSecs, "s"}),
      state(
          {{"live", Liveness::kLive}, {"stale", Liveness::kStale}, {"no data", Liveness::kNoData}},
          Liveness::kLive) {
  view.size = PixelSizeOfCases();
}

void GoldenCase::List(options::OptionList& option) {
  option("source", source, "recording, relative to the case, or demo:MOTION");
  option("time", time, "time after the first sample");
  option("state", state, "state of the stream that is shown");
  option("why", why, "purpose of the case, shown when it fails");
  view.List(option);
  person.List(option);
  loads.List(option);
}

GoldenCase LoadGoldenCase(const fs::path& yaml) {
  GoldenCase golden_case;
  golden_case.name = yaml.stem();
  golden_case.view.title = golden_case.name;
  options::OptionList list;
  golden_case.List(list);
  options::YamlOptions(yaml.string()).SetAll(list);
  for (const std::string& warning : list.warnings()) spdlog::warn(warning);
  if (golden_case.source->empty()) throw UsageError(yaml.string() + ": source is missing");
  if (!IsSubjectUrl(*golden_case.source)) {
    golden_case.source = (yaml.parent_path() / *golden_case.source).string();
  }
  WrenchFileValue& wrenches = golden_case.loads.measured.wrenches;
  if (wrenches.IsGiven()) wrenches = (yaml.parent_path() / *wrenches).string();
  return golden_case;
}

std::vector<GoldenCase> ReadGoldenCases(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  if (error) {
    throw UsageError(fmt::format("folder '{}': {}; name the folder that holds the golden cases",
                                 folder.string(), error.message()));
  }
  if (files.empty())
    throw UsageError(fmt::format("folder '{}' contains no golden case (*.yaml)", folder.string()));
  std::sort(files.begin(), files.end());
  std::vector<GoldenCase> cases;
  cases.reserve(files.size());
  for (const fs::path& file : files) cases.push_back(LoadGoldenCase(file));
  return cases;
}

GoldenDrawing Draw(const GoldenCase& golden_case, render::Renderer& renderer) {
  const SceneOptions options = ToShownSceneOptions(golden_case.person, golden_case.loads);
  RenderPlanner planner(golden_case.view, {}, options);
  if (planner.needs_prescan()) {
    SceneReader reader(*golden_case.source, options);
    PrescanClip({&planner}, reader, kSubjectPrescanSecs);
  }
  const RenderRequest request =
      planner.Only(SceneOf(golden_case, options, planner), *golden_case.time);
  GoldenDrawing drawing;
  drawing.image = renderer.Render(request.state, request.camera, request.spec);
  drawing.spheres = SpheresOf(request);
  if (request.spec.overlays && request.spec.parts.frame_code &&
      *golden_case.state != Liveness::kNoData) {
    drawing.frame_code = {request.state.counter, request.state.time_code_millis};
  }
  return drawing;
}

}  // namespace kinescope::app
