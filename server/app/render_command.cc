// `kinescope render`: one picture, or a clip on a fixed time grid, of a recording or the subject.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "render/new_file.h"
#include "render/png_file.h"
#include "render/renderer.h"
#include "render/video.h"
#include "server/app/commands.h"
#include "server/app/option_list.h"
#include "server/app/options.h"
#include "server/app/pipeline_options.h"
#include "server/app/progress.h"
#include "server/app/scene_reader.h"
#include "server/app/shots.h"
#include "server/app/stop_signal.h"
#include "server/app/view_options.h"
#include "server/core/clocks.h"

namespace kinescope::app {
namespace {

struct RenderOptions {
  std::string source;
  std::string out;
  std::optional<long> frame;
  std::optional<double> time;
  std::optional<double> seconds;
  double fps = 30;
  bool json = false;
  std::string overlay_layer;
  ViewOptions view;
  PersonOptions person;
  LoadOptions loads;
};

// An endless source (the built-in subject) gives a clip of this length unless told otherwise.
constexpr double kDefaultClipSecs = 10;

std::map<std::string, std::string> Provenance(const RenderOptions& options,
                                              const render::Renderer& renderer) {
  return {{"Software", "Kinescope " KINESCOPE_VERSION},
          {"Source", std::filesystem::path(options.source).filename().string()},
          {"Camera", options.view.camera},
          {"Renderer", renderer.renderer_string()}};
}

render::LayerFormat ToLayerFormat(const std::string& text) {
  if (text != "svg" && text != "pdf") {
    throw UsageError(fmt::format("--overlay_layer={}: expected svg or pdf", text));
  }
  return text == "svg" ? render::LayerFormat::kSvg : render::LayerFormat::kPdf;
}

SceneReader Open(const RenderOptions& options) {
  return SceneReader(options.source,
                     ToSceneOptions(options.person, SceneOptions().stale_secs, options.loads));
}

// A source is read once more where pictures depend on scenes after them.
void SurveyIfNeeded(const RenderOptions& options, ShotPlanner& planner,
                    std::optional<double> length) {
  if (!planner.needs_survey()) return;
  if (!length && options.source.rfind("demo:", 0) == 0) length = kDefaultClipSecs;
  SceneReader reader = Open(options);
  SurveyClip(planner, reader, length);
}

// `secs`: since the first sample.
SceneState SceneOfPicture(const RenderOptions& options, SceneReader& reader, double& secs) {
  if (options.time) {
    secs = *options.time;
    SceneTimeline timeline(reader);
    if (auto scene = timeline.At(*options.time)) return *scene;
    throw UsageError(fmt::format("--time={}: {} ends before", *options.time, options.source));
  }
  const long wanted = options.frame.value_or(0);
  long frame = 0;
  std::shared_ptr<const SceneState> state, first;
  while (frame <= wanted) {
    state = reader.Next();
    if (!state || StopRequested()) break;
    if (!first) first = state;
    ++frame;
  }
  if (!state) {
    throw UsageError(
        fmt::format("--frame={}: {} has {} frames, the first is 0", wanted, options.source, frame));
  }
  secs = Secs(state->stamp_nanos - first->stamp_nanos);
  return *state;
}

nlohmann::json RenderPicture(const RenderOptions& options, SceneReader& reader) {
  ShotPlanner planner(options.view);
  SurveyIfNeeded(options, planner, options.seconds);
  double secs = 0;
  SceneState scene = SceneOfPicture(options, reader, secs);
  Shot shot = planner.Only(std::move(scene), secs);
  const bool has_layer = !options.overlay_layer.empty();
  if (has_layer) shot.view.overlays = false;
  const auto renderer = render::MakeRenderer();
  const render::Image image = renderer->Render(shot.state, shot.camera, shot.view);
  render::WritePng(options.out, image, Provenance(options, *renderer));
  if (has_layer) {
    const std::string layer = renderer->OverlayLayer(shot.state, shot.camera, shot.view,
                                                     ToLayerFormat(options.overlay_layer));
    render::NewFile file(
        std::filesystem::path(options.out).replace_extension(options.overlay_layer));
    file.Write(layer.data(), layer.size());
    file.Commit();
  }
  return {{"pictures", 1}, {"counter", shot.state.counter}};
}

// How many pictures the clip will have, where that can be told; only for the progress line.
int ExpectedPictures(const RenderOptions& options, std::optional<double> length) {
  return length ? static_cast<int>(*length * options.fps + 1e-9) + 1 : 0;
}

nlohmann::json RenderClip(const RenderOptions& options, SceneReader& reader) {
  if (!(options.fps >= 1 && options.fps <= 240)) {
    throw UsageError(fmt::format("--fps={}: expected 1 to 240", options.fps));
  }
  const bool is_endless = options.source.rfind("demo:", 0) == 0;
  std::optional<double> length = options.seconds;
  if (!length && is_endless) length = kDefaultClipSecs;
  if (length && !(*length > 0)) {
    throw UsageError(fmt::format("--seconds={}: expected more than 0", *length));
  }

  ShotPlanner planner(options.view);
  SurveyIfNeeded(options, planner, length);
  const auto renderer = render::MakeRenderer();
  render::VideoOptions video_options;
  video_options.frames_per_second = options.fps;
  video_options.metadata = Provenance(options, *renderer);
  const auto video = render::MakeVideoWriter(options.out, planner.view().width,
                                             planner.view().height, video_options);

  SceneTimeline timeline(reader);
  render::Image image;
  Progress progress("pictures:", ExpectedPictures(options, length));
  int pictures = 0;
  for (;; ++pictures) {
    const double secs = pictures / options.fps;  // picture k shows t0 + k / fps, exactly
    if (length && secs >= *length - 1e-9) break;
    auto scene = timeline.At(secs);
    if (!scene) break;
    if (StopRequested())
      throw std::runtime_error("interrupted; " + options.out + " was not written");
    const Shot shot = planner.Next(std::move(*scene));
    renderer->RenderInto(image, shot.state, shot.camera, shot.view);
    video->Add(image);
    progress.Step();
  }
  if (pictures == 0) throw UsageError(options.source + " has no frame to show");
  video->Finish();
  return {{"pictures", pictures},
          {"seconds", pictures / options.fps},
          {"pictures_per_second", pictures / progress.secs()}};
}

void Render(const RenderOptions& options) {
  const std::string extension = std::filesystem::path(options.out).extension();
  if (extension != ".png" && extension != ".mp4") {
    throw UsageError(
        fmt::format("--out={}: expected a name that ends in .png or .mp4", options.out));
  }
  if (extension == ".mp4" && (options.frame || options.time)) {
    throw UsageError("--frame and --time choose one picture; give --out a name that ends in .png");
  }
  if (!options.overlay_layer.empty()) {
    ToLayerFormat(options.overlay_layer);
    if (extension != ".png") {
      throw UsageError(
          "--overlay_layer is beside one picture; give --out a name that ends in .png");
    }
  }
  SceneReader reader = Open(options);
  nlohmann::json result =
      extension == ".png" ? RenderPicture(options, reader) : RenderClip(options, reader);
  result["out"] = options.out;
  if (options.json) {
    fmt::print("{}\n", result.dump());
  } else {
    fmt::print("{}: {} picture{}\n", options.out, result["pictures"].get<int>(),
               result["pictures"] == 1 ? "" : "s");
  }
}

}  // namespace

void AddRender(CommandLine line) {
  CLI::App* command = line.app.add_subcommand("render", "A recording to a picture or a clip");
  const auto o = std::make_shared<RenderOptions>();
  command->add_option("source", o->source, kSourceKinds)->required();
  command->add_option("--out", o->out, "file to write: .png (one picture) or .mp4 (H.264)")
      ->required();
  command->add_option("--frame", o->frame, "which frame of the motion, from 0 (picture)");
  command->add_option("--time", o->time, "seconds after the first frame (picture)");
  command->add_option("--seconds", o->seconds, "length of the clip; default: all (demo: 10)");
  command->add_option("--fps", o->fps, "pictures a second of the clip")->capture_default_str();
  command->add_flag("--json", o->json, "tell the result as JSON");
  command->add_option("--overlay_layer", o->overlay_layer,
                      "svg or pdf: what is written over the picture goes into a file beside it");
  o->view.Visit(FlagAdder(*command));
  o->person.Visit(FlagAdder(*command));
  o->loads.Visit(FlagAdder(*command));
  command->callback([o] { Render(*o); });
}

}  // namespace kinescope::app
