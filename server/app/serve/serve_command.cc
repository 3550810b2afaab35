// `kinescope serve` and `kinescope bridge`: a source, live, to ROS, pictures and page.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "core/clocks.h"
#include "core/install_paths.h"
#include "core/latest.h"
#include "core/stop_signal.h"
#include "server/app/commands.h"
#include "server/app/serve/diagnostics.h"
#include "server/app/serve/picture_loop.h"
#include "server/app/serve/serve_options.h"
#include "server/app/serve/told_loads.h"
#include "server/app/serve/view_loop.h"
#include "server/http/server.h"
#include "server/loads/hand_loads.h"
#include "server/options/choose.h"
#include "server/options/option_list.h"
#include "server/ros/bridge.h"
#include "server/ros/graph_source.h"
#include "server/scene/scene_builder.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

// How long reading may wait: what decides how soon Ctrl-C and staleness are noticed.
constexpr std::chrono::milliseconds kPollTimeout(50);

// Says on the terminal when the stream comes, goes and comes back. Never once per sample.
class Announcer {
 public:
  void OnState(const SceneState& state) {
    if (has_spoken_ && state.liveness == liveness_) return;
    has_spoken_ = true;
    liveness_ = state.liveness;
    switch (state.liveness) {
      case Liveness::kNoData:
        spdlog::info("waiting for {}: nothing has come yet", state.source);
        break;
      case Liveness::kLive: spdlog::info("live: {} from {}", PersonIn(state), state.source); break;
      case Liveness::kStale:
        spdlog::warn("stale: nothing more from {} since sample {}", state.source, state.counter);
        break;
    }
  }

 private:
  static std::string PersonIn(const SceneState& state) {
    if (state.people.empty()) return "a person";
    const std::string& name = state.people.front().name;
    return name.empty() ? "a person" : "'" + name + "'";
  }
  bool has_spoken_ = false;
  Liveness liveness_ = Liveness::kNoData;
};

// Says once that datagrams come in and none of them can be shown: the likeliest first meeting with
// a suit whose streamer is set up for something else.
class UselessStreamWatch {
 public:
  void OnCounters(const SourceCounters& counters, const std::string& source, std::int64_t now) {
    if (has_spoken_ || counters.samples > 0 || counters.datagrams == 0) return;
    if (since_nanos_ == 0) since_nanos_ = now;
    if (now - since_nanos_ < kPatienceNanos) return;
    has_spoken_ = true;
    std::string reason = "no message of a pose is among them";
    std::uint64_t most = 0;
    for (const auto& [text, count] : counters.rejected) {
      if (count <= most) continue;
      most = count;
      reason = text;
    }
    spdlog::warn("{} datagrams from {} and nobody to show: {}. `kinescope inspect {}` says more",
                 counters.datagrams, source, reason, source);
  }

 private:
  static constexpr std::int64_t kPatienceNanos = 2'000'000'000;

  std::int64_t since_nanos_ = 0;
  bool has_spoken_ = false;
};

std::vector<http::CameraView> CameraViews() {
  std::vector<http::CameraView> views;
  for (const std::string& name : render::CameraNames()) {
    const render::Camera camera = render::NamedCamera(name, SceneState{});
    views.push_back({name, camera.position, camera.target, camera.up, camera.vertical_fov_rad});
  }
  return views;
}

http::HttpConfig ToHttpConfig(const ServeOptions& options) {
  http::HttpConfig config;
  config.bind_ip = options.bind_ip;
  config.port = options.http_port;
  config.token = options.token;
  config.web_root = FindResource("web");
  config.cameras = CameraViews();
  config.camera = options.camera;
  return config;
}

PictureOptions ToPictureOptions(const ServeOptions& options) {
  PictureOptions pictures;
  pictures.camera = options.camera;
  pictures.moves = options.camera_moves;
  if (CameraMan(pictures.camera, pictures.moves).needs_survey()) {
    throw UsageError(
        "--orbit=turn and --fit=clip need a clip that ends; live there are degrees a "
        "second, and --fit=now");
  }
  std::tie(pictures.width, pictures.height) = ToSize("picture_size", options.picture_size);
  if (!(options.picture_rate_hz >= 0.1 && options.picture_rate_hz <= 240)) {
    throw UsageError(
        fmt::format("--picture_rate_hz={}: expected 0.1 to 240", options.picture_rate_hz));
  }
  pictures.rate_hz = options.picture_rate_hz;
  pictures.backend = options.backend;
  return pictures;
}

ViewSettings ToViewSettings(const ServeOptions& options) {
  ViewSettings view;
  view.camera = options.view_camera.empty() ? options.camera : options.view_camera;
  std::tie(view.width, view.height) = ToSize("view_size", options.view_size);
  if (!(options.view_rate_hz >= 0.1 && options.view_rate_hz <= 240)) {
    throw UsageError(fmt::format("--view_rate_hz={}: expected 0.1 to 240", options.view_rate_hz));
  }
  view.rate_hz = options.view_rate_hz;
  view.backend = options.backend;
  return view;
}

// Whoever turned pictures off wants nothing to be drawn; a view asked for beside that is not there.
bool WantsView(const ServeOptions& options, bool with_page) {
  if (!with_page || !ToSwitch("view", options.view)) return false;
  if (ToSwitch("pictures", options.pictures)) return true;
  spdlog::info("pictures are off, and so there is no ~view/image_raw");
  return false;
}

void Serve(const ServeOptions& options, bool with_page) {
  const std::int64_t start_nanos = MonotonicNanos();
  const SceneOptions scene_options =
      ToSceneOptions(options.person, options.stale_secs, options.loads);
  const ros_bridge::RosMode ros_mode = ToRosMode(options.ros);
  ros_bridge::BridgeConfig bridge_config = ToBridgeConfig(options);
  bridge_config.check_hand_load = [](const HandLoad& load) { return loads::FindDefect(load); };
  if (with_page) bridge_config.markers = options.markers;
  bridge_config.with_view = ros_mode != ros_bridge::RosMode::kOff && ros_bridge::BuiltWithRos() &&
                            WantsView(options, with_page);
  const std::string url =
      options.udp_port == 0 ? options.source : fmt::format("udp://:{}", options.udp_port);
  SourceSettings source_settings;
  source_settings.stream.stamps = ToStamps(options.stamps);
  const std::unique_ptr<Source> source = OpenAtTrueRate(url, options.loop, source_settings);
  if (ros_bridge::IsGraphUrl(url) && bridge_config.tf != "off") {
    // Whoever publishes these people has their frames on /tf already. A second publisher of a frame
    // makes it shake for everybody, and we would hear ourselves.
    bridge_config.tf = "off";
    if (ros_mode != ros_bridge::RosMode::kOff) {
      spdlog::info("frames of people who come from {} are not published again (--tf off)", url);
    }
  }

  Latest<SceneState> states;       // reading thread -> page
  Latest<http::Picture> pictures;  // drawing thread -> page
  ToldLoads told;                  // page -> reading thread
  std::unique_ptr<PictureLoop> drawing;
  std::unique_ptr<ros_bridge::RosBridge> ros;
  std::unique_ptr<ViewLoop> view;
  Announcer announcer;
  SceneBuilder builder(scene_options, source->description(), source->nominal_rate_hz(),
                       [&](const std::shared_ptr<const SceneState>& state) {
                         if (ros) ros->Publish(*state);
                         states.Publish(state);
                         if (drawing) drawing->OnState(state);
                         if (view) view->OnState(state);
                         announcer.OnState(*state);
                       });
  if (ros_mode == ros_bridge::RosMode::kRequired ||
      (ros_mode == ros_bridge::RosMode::kAuto && ros_bridge::BuiltWithRos())) {
    bridge_config.initial_urdf = builder.InitialModel()->urdf_xml;
    ros = ros_bridge::MakeRosBridge(bridge_config, ros_mode);
  }
  builder.Start();

  std::optional<http::HttpServer> page;
  Latest<SourceCounters> counters;  // reading thread -> diagnostics
  const auto diagnostics = [&] {
    return DiagnosticsJson(states.Get(), counters.Get(),
                           ros ? std::optional(ros->status()) : std::nullopt,
                           drawing ? std::optional(drawing->status()) : std::nullopt,
                           view ? std::optional(view->status()) : std::nullopt);
  };
  if (with_page) {
    if (ToSwitch("pictures", options.pictures)) {
      drawing = std::make_unique<PictureLoop>(ToPictureOptions(options), states.Get(), pictures);
      spdlog::info("first picture {:.2f} s after start, drawn by {}",
                   Secs(MonotonicNanos() - start_nanos), drawing->status().renderer.renderer);
    }
    if (ros && bridge_config.with_view) {
      ViewSettings settings = ToViewSettings(options);
      settings.backend.backend = drawing->status().renderer.backend;
      view = std::make_unique<ViewLoop>(
          settings, states.Get(),
          [&](const ros_bridge::ViewPicture& picture) { ros->PublishView(picture); });
    }
    http::HttpConfig config = ToHttpConfig(options);
    config.set_hand_load = [&](int character, const HandLoad& load) {
      return told.Tell(character, load);
    };
    page.emplace(config, states, pictures, drawing.get(), diagnostics);
    spdlog::info("page at {}", page->url());
  }

  const auto transport = source->counters().transport;
  if (const auto buffer = transport.find("receive_buffer_bytes"); buffer != transport.end()) {
    spdlog::info("listening at {}, receive buffer {:.1f} MB", source->description(),
                 static_cast<double>(buffer->second) * 1e-6);
  }
  InputsFirst sink(builder, told, ros.get(), view.get());
  UselessStreamWatch useless_stream;
  std::int64_t counters_due = 0;
  while (!StopRequested()) {
    const Source::State more = source->Poll(kPollTimeout, sink);
    sink.TakeInputs();
    const std::int64_t now = MonotonicNanos();
    builder.Tick(now);
    if (now >= counters_due) {
      const auto newest = std::make_shared<const SourceCounters>(source->counters());
      counters.Publish(newest);
      useless_stream.OnCounters(*newest, source->description(), now);
      counters_due = now + 500'000'000;
    }
    if (ros && ros->status().told_to_stop) {
      spdlog::info("told to stop over ROS");
      break;
    }
    if (more == Source::State::kEnded) {
      if (!with_page) break;
      std::this_thread::sleep_for(kPollTimeout);  // the page stays up; only Ctrl-C ends it
    }
  }
  spdlog::info("stopping");
}

// Fills in what the command line left open: the YAML file, then ROS parameters.
void ReadOtherChannels(const CLI::App& command, const std::string& config, bool with_page,
                       ServeOptions& options) {
  const auto visit = [&](auto&& setter) {
    if (with_page) {
      options.Visit(setter);
    } else {
      options.VisitBridge(setter);
    }
  };
  if (!config.empty()) {
    const YamlValues yaml(config);
    ValueSetter setter(command, yaml);
    visit(setter);
    yaml.RefuseUnknown(setter.names());
  }
  // Parameters of a name like ~bind_ip can only be there when a master is.
  if (options.ros != "off" && ros_bridge::BuiltWithRos() && ros_bridge::MasterIsReachable()) {
    visit(ValueSetter(command, ros_bridge::PrivateParameter));
  }
}

void Add(CommandLine line, const char* name, const char* description, bool with_page) {
  CLI::App* command = line.app.add_subcommand(name, description);
  const auto options = std::make_shared<ServeOptions>();
  const auto config = std::make_shared<std::string>();
  if (with_page) {
    options->Visit(FlagAdder(*command, "source"));
  } else {
    options->VisitBridge(FlagAdder(*command, "source"));
  }
  command->add_option("--config", *config, "YAML file of `name: value` for any option above");
  command->footer("Each option is also the ROS parameter ~name.");
  command->callback([=] {
    ReadOtherChannels(*command, *config, with_page, *options);
    Serve(*options, with_page);
  });
}

}  // namespace

void AddServe(CommandLine line) {
  Add(line, "serve", "The main job: a source to ROS topics, pictures and a web page", true);
}

void AddBridge(CommandLine line) {
  Add(line, "bridge", "A source to ROS topics only; nothing is drawn", false);
}

}  // namespace kinescope::app
