#include "server/app/golden/golden_case.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>

#include "core/system/errors.h"
#include "core/system/sha256.h"
#include "render/multi_view.h"
#include "server/app/golden/golden_page.h"
#include "server/options/option_json.h"
#include "server/options/yaml_options.h"
#include "server/picture/moving_robots.h"
#include "server/picture/render_planner.h"
#include "server/picture/rviz_option.h"
#include "server/picture/scene_additions.h"
#include "server/scene/scene_reader.h"
#include "server/source/scheme.h"
#include "server/source/source_identity.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

constexpr long kMostFrames = 200;  // of a clip, that are compared

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

// Of several moments, each in its view.
RenderRequest RequestOfMoments(const GoldenCase& golden_case, const SceneOptions& options,
                               RenderPlanner& planner) {
  const std::string where =
      fmt::format("golden case {}: views: {}", golden_case.name, golden_case.view.views.ToText());
  if (*golden_case.state != Liveness::kLive || *golden_case.time != 0) {
    throw UsageError(where + ": names the moments; leave out time and state");
  }
  SceneReader reader(*golden_case.source, options);
  SceneTimeline timeline(reader);
  double before = 0;
  for (const double secs : planner.moment_times()) {
    CheckReach(where, secs, *golden_case.source);
    RememberBefore(secs, timeline, planner, before);
    std::optional<SceneState> scene = timeline.At(secs);
    if (!scene) {
      throw UsageError(
          fmt::format("{}: source {} ends before {} s", where, *golden_case.source, secs));
    }
    planner.AddMoment(*std::move(scene));
    before = secs;
  }
  return planner.Moments();
}

std::vector<render::SphereInPicture> SpheresOf(const RenderRequest& request) {
  const render::PictureSpec& spec = request.spec;
  const auto spheres_of = [&](const SceneState& state, const render::Camera& camera,
                              const render::Tile& tile) {
    auto spheres =
        render::LocateSpheres(render::Without(state, spec.look), camera, tile.width, tile.height);
    for (render::SphereInPicture& sphere : spheres) {
      sphere.x_px += tile.x;
      sphere.y_px += tile.y;
    }
    return spheres;
  };
  if (spec.panes.empty()) return spheres_of(request.state, request.camera, spec.SceneTile());
  std::vector<render::SphereInPicture> all;
  const auto tiles =
      render::PaneTiles(spec.SceneTile(), static_cast<int>(spec.panes.size()), spec.pane_columns);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    const render::Tile& tile = tiles[i];
    const render::Pane& pane = spec.panes[i];
    const SceneState& state = pane.scene != nullptr ? pane.scene->state : request.state;
    for (render::SphereInPicture& sphere : spheres_of(state, pane.camera, tile)) {
      const double r = sphere.radius_px;
      if (sphere.x_px < tile.x + r || sphere.x_px > tile.x + tile.width - r ||
          sphere.y_px < tile.y + r || sphere.y_px > tile.y + tile.height - r) {
        continue;
      }
      sphere.joint = pane.name + "/" + sphere.joint;
      all.push_back(std::move(sphere));
    }
  }
  return all;
}

// Of "FILE:3: time".
int LineOf(const std::string& given_as, const fs::path& yaml) {
  const std::size_t at = yaml.string().size() + 1;
  return at < given_as.size() ? std::max(1, std::atoi(given_as.c_str() + at)) : 1;
}

void CheckClip(const GoldenCase& golden_case, const fs::path& yaml) {
  if (golden_case.name.find(kFrameSign) != std::string::npos) {
    throw UsageError(
        fmt::format("{}: the name of a case has no '{}', which stands before the "
                    "number of a frame",
                    yaml.string(), kFrameSign));
  }
  if (!golden_case.seconds) return;
  if (*golden_case.state != Liveness::kLive || golden_case.view.views->has_times()) {
    throw UsageError(yaml.string() +
                     ": seconds: a clip has one moment per picture, of a live stream; leave out "
                     "state and the times of views");
  }
}

void AddFacts(const RenderRequest& request, render::Renderer& renderer, GoldenDrawing& drawing) {
  const render::PictureSpec& spec = request.spec;
  const render::PictureContents contents =
      renderer.Contents(request.state, request.camera, request.spec);
  PictureFacts& facts = drawing.facts;
  facts.objects = ObjectFactsOf(contents, drawing.spheres);
  facts.texts = TextFactsOf(contents);
  if (spec.look.Shows(render::ScenePart::kBody))
    facts.joints = JointFactsOf(JointTurnsOf(request.state));
  facts.has_floor = spec.look.floor;
  if (facts.has_floor) facts.floor_z_m = request.state.floor_z;
  if (spec.panes.empty()) facts.cameras.push_back({"", request.camera});
  for (const render::Pane& pane : spec.panes) facts.cameras.push_back({pane.name, pane.camera});
  drawing.places = ObjectPlacesOf(contents);
}

GoldenDrawing DrawOne(const GoldenCase& golden_case, const RenderRequest& request,
                      render::Renderer& renderer) {
  GoldenDrawing drawing;
  drawing.image = renderer.Render(request.state, request.camera, request.spec);
  drawing.spheres = SpheresOf(request);
  AddFacts(request, renderer, drawing);
  if (request.spec.overlays && request.spec.parts.frame_code &&
      *golden_case.state != Liveness::kNoData) {
    drawing.frame_code = {request.state.counter, request.state.time_code_millis};
  }
  return drawing;
}

// All pictures of the clip are planned, because a camera that follows depends on those before.
void DrawClip(const GoldenCase& golden_case, const SceneOptions& options,
              render::Renderer& renderer, const std::function<void(GoldenDrawing)>& on_drawing) {
  const double begin = *golden_case.time, length = *golden_case.seconds, fps = *golden_case.fps;
  const std::string where = fmt::format("golden case {}: seconds: {}", golden_case.name, length);
  const long count = std::max(1L, std::lround(std::floor(length * fps + 1e-9)));
  if (count / *golden_case.every >= kMostFrames) {
    throw UsageError(
        fmt::format("{}: {} pictures would be compared, {} at most; write a larger "
                    "`every`",
                    where, count / *golden_case.every + 1, kMostFrames));
  }
  CheckReach(where, begin + length, *golden_case.source);
  RenderPlanner planner(golden_case.view, SceneAdditions(golden_case.view, {}, options),
                        Fit::kClip);
  if (planner.needs_prescan()) {
    SceneReader reader(*golden_case.source, options);
    PrescanClip({&planner}, reader, begin + length);
  }
  SceneReader reader(*golden_case.source, options);
  SceneTimeline timeline(reader);
  RememberBefore(begin, timeline, planner);
  for (long number = 0; number < count; ++number) {
    const double secs = begin + static_cast<double>(number) / fps;
    std::optional<SceneState> scene = timeline.At(secs);
    if (!scene) {
      throw UsageError(fmt::format("{}: source {} ends at {:.3f} s, before the clip", where,
                                   *golden_case.source, timeline.NewestSecs()));
    }
    const RenderRequest request = planner.Next(*std::move(scene));
    if (number % *golden_case.every != 0) continue;
    GoldenDrawing drawing = DrawOne(golden_case, request, renderer);
    drawing.frame = {number, secs};
    on_drawing(std::move(drawing));
  }
}

}  // namespace

GoldenCase::GoldenCase()
    : time(0, {0, kLatestSecs, "s"}),
      seconds(options::Number(0, {0, kLatestSecs, "s", true})),
      fps(30, {1, 240, "pictures per second"}),
      every(15, {1, 100'000, ""}),
      state(
          {{"live", Liveness::kLive}, {"stale", Liveness::kStale}, {"no data", Liveness::kNoData}},
          Liveness::kLive) {
  view.size = PixelSizeOfCases();
}

void GoldenCase::List(options::OptionList& option) {
  option("source", source,
         "recording, relative to the case, demo:MOTION, or pose:ANGLES (docs/pose.md)");
  option("page", page,
         "web page in place of a scene: its address, a file, relative to the case, or dashboard, "
         "which shows the source at the time");
  option("time", time, "time after the first sample");
  option("seconds", seconds, "of a clip, which begins at that time: its length");
  option("fps", fps, "of a clip: its frame rate, pictures per second");
  option.HasNoEffect("fps", "without seconds", [this] { return !seconds; });
  option("every", every, "of a clip: every n-th picture is compared");
  option.HasNoEffect("every", "without seconds", [this] { return !seconds; });
  option("state", state, "state of the stream that is shown");
  option("mask", masks, "part of the picture that may show anything, and why; may be repeated");
  option("tolerance", limits, "limit of a layer that is not the default, and why; may be repeated");
  option("why", why, "purpose of the case, shown when it fails");
  option("rviz", rviz, kRvizHelp);
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
  options::YamlOptions(yaml.string()).SetAll(list, "`kinescope golden keys`");
  list.CheckEffects();
  for (const std::string& warning : list.warnings()) spdlog::warn(warning);
  for (const options::Option& option : list) {
    if (option.given_as.empty()) continue;
    golden_case.lines[option.name] = LineOf(option.given_as, yaml);
    if (option.name == "why") continue;
    golden_case.given[option.name] = options::ToJson(*option.value);
  }
  if (!golden_case.page->empty()) {
    ResolvePage(golden_case, yaml);
  } else if (golden_case.source->empty()) {
    throw UsageError(yaml.string() +
                     ": source is missing: a recording, demo:MOTION, or pose:ANGLES");
  }
  CheckClip(golden_case, yaml);
  if (*golden_case.view.loads == render::LoadsShown::kSkin) {
    throw UsageError(yaml.string() +
                     ": loads: skin hides the load spheres, which are compared; use both");
  }
  if (!golden_case.source->empty() && !IsSubjectUrl(*golden_case.source)) {
    golden_case.source = (yaml.parent_path() / *golden_case.source).string();
  }
  for (options::Option& option : list) option.value->SetFolder(yaml.parent_path());
  // Whose topics need a bag, so the source is known by now.
  if (golden_case.rviz.IsGiven()) {
    ApplyRviz(golden_case.rviz, ToPictureSpec(golden_case.view).height, list);
  }
  return golden_case;
}

std::vector<InputFact> InputsOf(const GoldenCase& golden_case) {
  std::vector<InputFact> inputs;
  if (!golden_case.source->empty()) {
    const SourceIdentity source = IdentityOf(*golden_case.source);
    inputs.push_back({"source", source.name, source.digest ? source.digest->sha256 : ""});
  }
  if (!golden_case.page_file.empty()) {
    inputs.push_back(
        {"page", golden_case.page_file.filename(), DigestOf(golden_case.page_file).sha256});
  }
  GoldenCase copy = golden_case;  // a list refers to values that can be set
  options::OptionList list;
  copy.List(list);
  for (const auto& input : options::InputsOf(list)) {
    inputs.push_back({input.at("option"), input.at("name"), input.at("sha256")});
  }
  return inputs;
}

void Draw(const GoldenCase& golden_case, render::Renderer& renderer,
          const std::function<void(GoldenDrawing)>& on_drawing) {
  if (!golden_case.page->empty()) return on_drawing(DrawPageOf(golden_case));
  SceneOptions options = ToShownSceneOptions(golden_case.person, golden_case.loads);
  AddBagView(golden_case.view, options);
  if (golden_case.seconds) return DrawClip(golden_case, options, renderer, on_drawing);
  RenderPlanner planner(golden_case.view, {}, options);
  if (planner.needs_prescan()) {
    SceneReader reader(*golden_case.source, options);
    PrescanClip({&planner}, reader, kSubjectPrescanSecs);
  }
  const RenderRequest request =
      golden_case.view.views->has_times()
          ? RequestOfMoments(golden_case, options, planner)
          : planner.Only(SceneOf(golden_case, options, planner), *golden_case.time);
  on_drawing(DrawOne(golden_case, request, renderer));
}

}  // namespace kinescope::app
