// `kinescope serve` and `kinescope bridge`: a source, live, to ROS, pictures and page.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/clocks.h"
#include "core/install_paths.h"
#include "core/latest.h"
#include "core/stop_signal.h"
#include "server/app/commands.h"
#include "server/app/serve/diagnostics.h"
#include "server/app/serve/hand_load_mailbox.h"
#include "server/app/serve/input_merger.h"
#include "server/app/serve/live_pictures.h"
#include "server/app/serve/ros_camera_loop.h"
#include "server/app/serve/serve_options.h"
#include "server/http/server.h"
#include "server/loads/hand_loads.h"
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
      case Liveness::kNoData: spdlog::info("waiting for data from {}", state.source); break;
      case Liveness::kLive: spdlog::info("live: {} from {}", PersonIn(state), state.source); break;
      case Liveness::kStale:
        spdlog::warn("stale: no data from {} since sample {}", state.source, state.counter);
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
    std::string reason = "pose messages are missing";
    std::uint64_t most = 0;
    for (const auto& [text, count] : counters.rejected) {
      if (count <= most) continue;
      most = count;
      reason = text;
    }
    spdlog::warn(
        "{} datagrams from {}, but no complete pose: {}. For details run `kinescope inspect {}`",
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

http::CameraFraming FramingOfCameras() {
  const render::GroupFraming& framing = render::kGroupFraming;
  return {framing.min_width_m, framing.margin_m, framing.narrowest_aspect};
}

http::HttpConfig ToHttpConfig(const ServeOptions& options) {
  http::HttpConfig config;
  config.bind_ip = *options.bind_ip;
  config.port = static_cast<int>(*options.http_port);
  config.token = *options.token;
  config.web_root = FindResource("web");
  config.cameras = CameraViews();
  config.framing = FramingOfCameras();
  config.camera = options.camera->front().text;
  return config;
}

LivePictureSettings ToLivePictureSettings(const ServeOptions& options) {
  LivePictureSettings pictures;
  pictures.moves = options.camera_moves;
  pictures.camera = CameraController(options.camera->front(), pictures.moves);
  if (pictures.camera.needs_survey()) {
    throw UsageError(
        "--orbit=turn and --fit=clip need a clip that ends; a live picture takes degrees per "
        "second, "
        "and --fit=now");
  }
  pictures.width = options.picture_size->width;
  pictures.height = options.picture_size->height;
  pictures.rate_hz = *options.picture_rate_hz;
  return pictures;
}

RosCameraSettings ToViewSettings(const ServeOptions& options) {
  RosCameraSettings view;
  view.camera = CameraController(
      options.view_camera ? (*options.view_camera).front() : options.camera->front(), {});
  view.width = options.view_size->width;
  view.height = options.view_size->height;
  view.rate_hz = *options.view_rate_hz;
  return view;
}

// A view needs the server's pictures.
bool WantsView(const ServeOptions& options, bool with_page) {
  if (!with_page || !*options.view) return false;
  if (*options.pictures) return true;
  spdlog::info("~view/image_raw is off because --pictures is off");
  return false;
}

// Everything that can be wrong with the options is found before anything starts, also in parts that
// are off.
void CheckServeOptions(const ServeOptions& options) {
  ToLivePictureSettings(options);
  ToViewSettings(options);
}

void Serve(const ServeOptions& options, bool with_page) {
  const std::int64_t start_nanos = MonotonicNanos();
  CheckServeOptions(options);
  const SceneOptions scene_options =
      ToShownSceneOptions(options.person, options.loads, *options.stale_secs);
  const ros_bridge::RosMode ros_mode = *options.ros;
  ros_bridge::BridgeConfig bridge_config = ToBridgeConfig(options);
  bridge_config.check_hand_load = [](const HandLoad& load) { return loads::FindDefect(load); };
  if (with_page) bridge_config.markers = *options.markers;
  bridge_config.with_view = ros_mode != ros_bridge::RosMode::kOff && ros_bridge::BuiltWithRos() &&
                            WantsView(options, with_page);
  const std::string url =
      *options.udp_port == 0 ? *options.source : fmt::format("udp://:{}", *options.udp_port);
  SourceSettings source_settings;
  source_settings.stream.stamps = *options.stamps;
  const std::unique_ptr<Source> source = OpenAtTrueRate(url, *options.loop, source_settings);
  if (ros_bridge::IsGraphUrl(url) && bridge_config.tf != "off") {
    // Whoever publishes these people has their frames on /tf already. A second publisher of a frame
    // makes it shake for everybody, and we would hear ourselves.
    bridge_config.tf = "off";
    if (ros_mode != ros_bridge::RosMode::kOff) {
      spdlog::info("TF frames of people from {} are not republished (as with --tf=off)", url);
    }
  }

  Latest<SceneState> states;       // reading thread -> page
  Latest<http::Picture> pictures;  // drawing thread -> page
  HandLoadMailbox hand_loads;      // page -> reading thread
  std::unique_ptr<LivePictures> drawing;
  std::unique_ptr<ros_bridge::RosBridge> ros;
  std::unique_ptr<RosCameraLoop> view;
  Announcer announcer;
  SceneBuilder builder(scene_options, source->description(), source->nominal_rate_hz(),
                       [&](const std::shared_ptr<const SceneState>& state) {
                         if (ros) ros->Publish(*state);
                         states.Publish(state);
                         if (drawing) drawing->OnState(state);
                         if (view) view->OnState(state);
                         announcer.OnState(*state);
                       });
  std::shared_ptr<const PersonModel> initial_model;  // its meshes stay as long as this does
  if (ros_mode == ros_bridge::RosMode::kRequired ||
      (ros_mode == ros_bridge::RosMode::kAuto && ros_bridge::BuiltWithRos())) {
    initial_model = builder.InitialModel();
    if (initial_model->mesh_files) initial_model->mesh_files->Provide();
    bridge_config.initial_urdf = initial_model->urdf_xml;
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
    if (*options.pictures) {
      const RendererFactory make_renderer = RenderersOf(options.backend);
      drawing = std::make_unique<LivePictures>(ToLivePictureSettings(options), make_renderer,
                                               states.Get(), pictures);
      spdlog::info("first picture {:.2f} s after start, rendered by {}",
                   Secs(MonotonicNanos() - start_nanos), drawing->status().renderer.renderer);
      if (ros && bridge_config.with_view) {
        view = std::make_unique<RosCameraLoop>(
            ToViewSettings(options), make_renderer, states.Get(),
            [&](const ros_bridge::RosImage& picture) { ros->PublishView(picture); });
      }
    }
    http::HttpConfig config = ToHttpConfig(options);
    config.set_hand_load = [&](int character, const HandLoad& load) {
      return hand_loads.Put(character, load);
    };
    page.emplace(config, states, pictures, drawing.get(), diagnostics);
    spdlog::info("page at {}", page->url());
  }

  const auto transport = source->counters().transport;
  if (const auto buffer = transport.find("receive_buffer_bytes"); buffer != transport.end()) {
    spdlog::info("listening at {}, receive buffer {:.1f} MB", source->description(),
                 static_cast<double>(buffer->second) * 1e-6);
  }
  InputMerger sink(builder, hand_loads, ros.get(), [&](int count) {
    if (view) view->SetSubscribers(count);
  });
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
    if (ros && ros->status().shutdown_requested) {
      spdlog::info("shut down through ROS");
      break;
    }
    if (more == Source::State::kEnded) {
      if (!with_page) break;
      std::this_thread::sleep_for(kPollTimeout);  // the page stays up; only Ctrl-C ends it
    }
  }
  spdlog::info("stopping");
}

// Private parameters of this node: ~name.
void ReadParameters(const ServeOptions& options, options::OptionList& list) {
  const bool can_be_there = *options.ros != ros_bridge::RosMode::kOff &&
                            ros_bridge::BuiltWithRos() && ros_bridge::MasterIsReachable();
  if (!can_be_there) return;
  options::SetFrom(
      [](const std::string& name) -> std::optional<options::Found> {
        const auto text = ros_bridge::PrivateParameter(name);
        if (!text) return std::nullopt;
        return options::Found{*text, "~"};
      },
      options::Channel::kParameter, list);
}

Command Make(const char* name, const char* about, bool with_page) {
  const auto values = std::make_shared<ServeOptions>();
  Command command;
  command.name = name;
  command.about = about;
  if (with_page) {
    values->List(command.options);
  } else {
    values->ListBridge(command.options);
  }
  command.positionals = {"source"};
  command.footer =
      "Every option is also a private ROS parameter: ~name. Order of precedence: command "
      "line, ROS parameter, --config file.";
  command.run = [values, with_page](options::OptionList& list) {
    ReadParameters(*values, list);
    Serve(*values, with_page);
    return 0;
  };
  return command;
}

}  // namespace

Command ServeCommand() {
  return Make("serve", "Shows a source live: ROS topics, pictures and a web page", true);
}

Command BridgeCommand() {
  return Make("bridge", "Publishes a source to ROS; draws nothing", false);
}

}  // namespace kinescope::app
