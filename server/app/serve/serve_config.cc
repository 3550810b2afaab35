#include "server/app/serve/serve_config.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <stdexcept>

#include "core/system/errors.h"
#include "core/system/install_paths.h"
#include "core/system/ip_networks.h"
#include "core/system/starts_with.h"
#include "core/system/state_folder.h"
#include "render/camera/camera.h"
#include "server/alarms/rule_file.h"
#include "server/app/serve/page_token.h"
#include "server/loads/hand_loads.h"
#include "server/mvn/open.h"
#include "server/options/text.h"
#include "server/picture/moving_robots.h"
#include "server/ros/source/graph_source.h"

namespace kinescope::app {
namespace {

std::string TurnName(CameraBase::Turn turn) {
  switch (turn) {
    case CameraBase::Turn::kHeading: return "heading";
    case CameraBase::Turn::kFull: return "pose";
    case CameraBase::Turn::kNone: break;
  }
  return "none";
}

http::CameraView OwnCamera(const render::Camera& place, const CameraOptions& moves) {
  const double fov_rad = moves.fov ? *moves.fov * M_PI / 180 : place.vertical_fov_rad;
  return {http::kOwnCamera, place.position, place.target,
          place.up,         fov_rad,        TurnName(moves.camera_tf->turn)};
}

std::vector<http::CameraView> CameraViews(const ServeOptions& options) {
  std::vector<http::CameraView> views;
  for (const std::string& name : render::CameraNames()) {
    const render::Camera camera = render::NamedCamera(name, SceneState{});
    views.push_back({name, camera.position, camera.target, camera.up, camera.vertical_fov_rad});
  }
  const CameraChoice& given = options.camera->front();
  if (given.place) views.push_back(OwnCamera(*given.place, options.camera_moves));
  return views;
}

http::CameraFraming FramingOfCameras() {
  const render::GroupFraming& framing = render::kGroupFraming;
  return {framing.min_width_m, framing.margin_m, framing.narrowest_aspect, framing.reach_m,
          framing.height_m};
}

// @throws UsageError
IpNetworks TrustedProxies(const std::string& text) {
  if (text.empty()) return {};
  try {
    return IpNetworks(text);
  } catch (const std::invalid_argument& failure) {
    throw UsageError("--trusted_proxies=" + text + ": " + failure.what());
  }
}

std::vector<http::PageTrail> TrailsOf(const TrailOptions& options) {
  const TrailSettings settings = options.Settings();
  std::vector<http::PageTrail> trails;
  for (render::Trail& trail : Trails(settings).WithoutPoints()) {
    trails.push_back({settings.tracks[trails.size()], trail.color, std::move(trail.name)});
  }
  return trails;
}

http::HttpConfig PageOf(const ServeOptions& options) {
  http::HttpConfig config;
  config.bind_ip = *options.bind_ip;
  config.port = static_cast<int>(*options.http_port);
  config.tls = {*options.tls_certificate, *options.tls_key};
  config.base_path = *options.base_path;
  config.trusted_proxies = TrustedProxies(*options.trusted_proxies);
  config.web_root = FindResource("web");
  config.web_bundle = FindWebBundle();
  config.cameras = CameraViews(options);
  config.framing = FramingOfCameras();
  config.camera =
      AreAllNamed(*options.camera) ? options.camera->front().text : std::string(http::kOwnCamera);
  const render::Figure figure = options.figure.Load();
  config.look = {figure.kind == render::Figure::kSkin,
                 options.loads_shown.ToText(),
                 options.style.ToText(),
                 *options.body_opacity,
                 TrailsOf(options.trails),
                 *options.trails.secs};
  config.own_skin = figure.own_skin;
  return config;
}

marks::BookSettings MarksOf(const ServeOptions& options) {
  const std::string file = *options.marks_file;
  return {file.empty() ? marks::DefaultMarkFile() : std::filesystem::path(file),
          options::SplitItems(*options.mark_names)};
}

// A clip looks as the live picture does. Its codec needs even sides.
ClipSettings ClipsOf(const ServeOptions& options, const SceneOptions& scene) {
  ClipSettings clips;
  const int width = options.picture_size->width / 2 * 2,
            height = options.picture_size->height / 2 * 2;
  clips.view.size.Parse(fmt::format("{}x{}", width, height));
  clips.own_camera = options.camera->front().text;
  clips.view.moves = options.camera_moves;
  clips.view.figure = options.figure;
  clips.view.style = options.style;
  clips.view.loads = options.loads_shown;
  clips.view.body_opacity = options.body_opacity;
  clips.view.background = options.background;
  if (const auto& color = options.background->color) {
    const bool is_dark = render::ThemeOn(*color) == render::Theme::kDark;
    clips.view.theme.Parse(is_dark ? "dark" : "light");
  }
  clips.view.trails = options.trails;
  clips.view.robot = options.robot.WithoutMoving();
  clips.view.ghost = options.ghost;
  clips.view.ghost_opacity = options.ghost_opacity;
  clips.backend = options.backend;
  clips.scene = scene;
  return clips;
}

void AddRecordings(const ServeOptions& options, ServeConfig& config) {
  const std::string folder = *options.recordings_folder;
  config.recordings = folder.empty() ? StateFolder() / "recordings" : std::filesystem::path(folder);
  config.may_make_recordings = folder.empty();
  config.loads_options = LoadsOptionsOf(options.person, options.loads);
  std::error_code ignored;
  if (folder.empty() || std::filesystem::is_directory(folder, ignored)) return;
  throw UsageError("--recordings_folder=" + folder + ": no such folder; make it first");
}

LivePictureSettings LivePicturesOf(const ServeOptions& options) {
  LivePictureSettings pictures;
  pictures.moves = options.camera_moves;
  pictures.camera = CameraController(options.camera->front(), pictures.moves);
  if (pictures.camera.needs_prescan()) {
    throw UsageError(
        "--orbit=turn and --fit=clip need a clip that ends; a live picture takes degrees per "
        "second, and --fit=now");
  }
  pictures.width = options.picture_size->width;
  pictures.height = options.picture_size->height;
  pictures.rate_hz = *options.picture_rate_hz;
  pictures.people =
      LoadPeopleLook(options.figure, options.style, options.loads_shown, options.body_opacity);
  if (options.background->is_transparent) {
    throw UsageError(
        "--background=transparent: the live picture is a JPEG, which is never transparent; "
        "expected theme, white, black or #RRGGBB");
  }
  pictures.background = options.background->color;
  pictures.trails = options.trails.Settings();
  return pictures;
}

RosCameraSettings RosCameraOf(const ServeOptions& options) {
  RosCameraSettings settings;
  const CameraChoice& camera =
      options.ros_view_camera ? (*options.ros_view_camera).front() : options.camera->front();
  CameraOptions options_of_ros;
  // A camera that was placed belongs with its field of view, as RViz has it.
  if (!options.ros_view_camera && camera.place) {
    options_of_ros.fov = options.camera_moves.fov;
    options_of_ros.projection = options.camera_moves.projection;
    options_of_ros.camera_tf = options.camera_moves.camera_tf;
  }
  options_of_ros.camera_frame = CameraFrame::kWorld;  // as RViz's views
  settings.camera = CameraController(camera, options_of_ros);
  settings.width = options.ros_view_size->width;
  settings.height = options.ros_view_size->height;
  settings.rate_hz = *options.ros_view_rate_hz;
  settings.people =
      LoadPeopleLook(options.figure, options.style, options.loads_shown, options.body_opacity);
  settings.background = options.background->color;
  settings.trails = options.trails.Settings();
  return settings;
}

ros_bridge::BridgeConfig BridgeOf(const ServeOptions& options) {
  ros_bridge::BridgeConfig config;
  config.reference_frame = *options.reference_frame;
  config.description = *options.description;
  config.tf = *options.tf;
  config.joint_states = *options.joint_angle_source;
  config.external_scale = *options.external_scale;
  config.check_hand_load = [](const HandLoad& load) { return loads::FindDefect(load); };
  return config;
}

// ns; nullopt: not given.
std::optional<std::int64_t> MomentOf(const char* name, const SecsOption& moment,
                                     const ServeOptions& options) {
  if (!moment) return std::nullopt;
  if (*options.udp_port != 0 || IsLiveUrl(*options.source)) {
    throw UsageError(fmt::format("{}={}: a live source has no such moment; expected {}", name,
                                 moment.ToText(), RecordedSourceKinds()));
  }
  return std::llround(*moment * 1e9);
}

// Without its page and pictures.
ServeConfig BridgeConfigOf(const ServeOptions& options) {
  ServeConfig config;
  config.source_url =
      *options.udp_port == 0 ? *options.source : fmt::format("udp://:{}", *options.udp_port);
  config.source_url = mvn::ReceivingFrom(config.source_url, *options.from);
  config.source_reach = mvn::DescribeReach(config.source_url);
  config.loop = *options.loop;
  config.start_at = MomentOf("--start_at", options.start_at, options).value_or(0);
  config.stop_at = MomentOf("--stop_at", options.stop_at, options);
  config.source.stream = {*options.stamps, mvn::Delivery::kPrompt};
  config.scene = ToShownSceneOptions(options.person, options.loads, *options.stale_secs);
  config.source.subject_height_m = config.scene.height_m;
  config.scene.makes_models_aside = !config.stop_at;
  config.alarms = alarms::LoadRules(*options.alarms);
  config.scene.view_frame = *options.camera_moves.camera_frame;
  config.ros_mode = config.stop_at ? ros_bridge::RosMode::kOff : *options.ros;
  if (config.ros_mode == ros_bridge::RosMode::kOff ||
      (config.ros_mode == ros_bridge::RosMode::kAuto && !ros_bridge::BuiltWithRos())) {
    return config;
  }
  config.ros = BridgeOf(options);
  UseMeshFiles(MeshCache::Lifetime::kProcess, config.scene);
  config.ros->finds_frame = ros_bridge::IsGraphUrl(config.source_url);
  if (config.ros->finds_frame && config.ros->tf != "none") {
    // The frames of these people are on /tf already. With a second publisher they would jump
    // between two poses, and Kinescope would receive its own.
    config.ros->tf = "none";
    config.ros->people_are_of_graph = true;
    // Links have the names of these frames, so that RViz shows the body.
    config.scene.takes_names = config.scene.model_name == SceneOptions().model_name &&
                               !EndsWith(config.source_url, "link_states");
    config.notes.push_back(fmt::format(
        "TF frames of people from {} are not republished (as with --tf=none)", config.source_url));
  }
  return config;
}

// A bag that is played has transforms and topics of its own; what else moves a robot is the graph.
void AddGraphView(const ServeOptions& options, ServeConfig& config) {
  const bool is_bag = IsBag(config.source_url);
  std::vector<GraphRobot> robots = ReadMovingRobots(*options.robot);
  config.source.bag = config.scene.bag;
  const CameraFrames camera_frame = options.camera_moves.camera_tf->frames();
  config.scene.camera_frame = camera_frame;
  config.source.bag.reference_frame = *options.reference_frame;
  if (is_bag) {
    config.source.bag.needs_person = false;
    config.source.bag.topics = *options.marker_topics;
    config.source.bag.camera_frame = camera_frame;
  }
  std::vector<GraphRobot> of_graph;
  for (GraphRobot& robot : robots) {
    const bool is_of_bag = is_bag && robot.parameter.empty();
    (is_of_bag ? config.source.bag.robots : of_graph).push_back(std::move(robot));
  }
  if (config.ros) {
    for (const ShownTopic& topic : *options.marker_topics) {
      const bool is_of_bag = topic.leaves_out_others || (is_bag && topic.is_frame);
      if (!is_of_bag) config.ros->shown.topics.push_back(topic);
    }
    config.ros->shown.robots = std::move(of_graph);
    if (!is_bag) config.ros->shown.camera_frame = camera_frame;
    return;
  }
  for (const GraphRobot& robot : of_graph) {
    if (robot.parameter.empty()) {
      throw UsageError(
          "--robot=" + options.robot.ToText() +
          ": a robot is moved by the transforms of a ROS graph or of a bag; this server has "
          "neither (--ros, --source)");
    }
    config.notes.push_back(fmt::format(
        "robot of the parameter {}: not shown, this server has no ROS (--ros)", robot.parameter));
  }
}

}  // namespace

ServeConfig MakeServeConfig(const ServeOptions& options, bool with_page) {
  const LivePictureSettings pictures = LivePicturesOf(options);
  const RosCameraSettings ros_camera = RosCameraOf(options);
  ServeConfig config = BridgeConfigOf(options);
  if (!with_page) return config;
  config.page = PageOf(options);
  if (*options.history_minutes > 0) {
    config.history.emplace();
    config.history->nanos = std::llround(*options.history_minutes * 60e9);
    config.marks = MarksOf(options);
  }
  const PageToken token = FindPageToken(kOperatorToken, {*options.token, options.token_given_as},
                                        *options.token_file, std::getenv(kOperatorToken.variable));
  config.page->token = token.text;
  if (!token.origin.empty()) config.page->token_origin = token.origin;
  config.how_to_see_token = token.how_to_see;
  const PageToken viewer_token =
      FindPageToken(kViewerToken, {*options.viewer_token, options.viewer_token_given_as},
                    *options.viewer_token_file, std::getenv(kViewerToken.variable));
  config.page->viewer_token = viewer_token.text;
  if (!viewer_token.origin.empty()) config.page->viewer_token_origin = viewer_token.origin;
  config.how_to_see_viewer_token = viewer_token.how_to_see;
  for (const PageToken& each : {token, viewer_token}) {
    config.notes.insert(config.notes.end(), each.notes.begin(), each.notes.end());
  }
  http::CheckConfig(*config.page);
  config.backend = options.backend;
  config.robots = *options.robot;
  AddGraphView(options, config);
  config.ghost = options.ghost;
  config.ghost_opacity = *options.ghost_opacity;
  if (*options.pictures) config.pictures = pictures;
  AddRecordings(options, config);
  if (config.pictures && config.history) {
    config.clips = ClipsOf(options, config.scene);
    config.clip_options = PictureOptionsOf(config.clips->view, config.clips->backend);
    config.clips->view.robot = {};  // former states have all robots
  }
  if (!config.ros) return config;
  if (!*options.ros_view) return config;
  if (!config.pictures) {
    config.notes.emplace_back("~view/image_raw is off because --pictures is off");
    return config;
  }
  config.ros->with_view = true;
  config.ros_camera = ros_camera;
  return config;
}

}  // namespace kinescope::app
