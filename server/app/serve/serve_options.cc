#include "server/app/serve/serve_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/picture_limits.h"
#include "core/system/utf8.h"
#include "server/marks/mark_book.h"
#include "server/options/ros_names.h"
#include "server/options/text.h"
#include "server/scene/scene_reader.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

constexpr double kMinFactor = 1e-6, kMaxFactor = 1e6;

options::Choice<std::string>::Words Words(const std::vector<std::string>& names) {
  options::Choice<std::string>::Words words;
  for (const std::string& name : names) words.emplace_back(name, name);
  return words;
}

bool AreMarkNames(const std::string& text) {
  constexpr std::size_t kLongest = 40;  // characters, so that a button has room for it
  const auto is_letter = [](unsigned char byte) { return std::isalnum(byte) != 0 || byte >= 0x80; };
  const std::vector<std::string> names = options::SplitItems(text);
  return names.size() <= marks::kButtons &&
         std::all_of(names.begin(), names.end(), [&](const std::string& name) {
           return std::any_of(name.begin(), name.end(), is_letter) && PrintableLine(name) == name &&
                  DecodeUtf8(name).size() <= kLongest;
         });
}

}  // namespace

void FactorValue::Parse(const std::string& text) {
  const auto number = options::ParseNumber(text);
  if (!number || std::abs(*number) < kMinFactor || std::abs(*number) > kMaxFactor) RefuseText();
  value_ = *number;
}

std::string FactorValue::ToText() const { return options::NumberText(value_); }

std::string FactorValue::Expected() const {
  return fmt::format("1, -1 or another factor whose size is from {} to {}", kMinFactor, kMaxFactor);
}

ServeOptions::ServeOptions()
    : source("udp://:9763"),
      udp_port(0, {0, 65535, "", false, "0: the port of --source"}),
      stamps({{"fitted", mvn::Stamps::kFitted}, {"arrival", mvn::Stamps::kArrival}},
             mvn::Stamps::kFitted),
      stale_secs(StaleSecs()),
      start_at(options::Number(0, {0, kLatestSecs, "s"})),
      alarms("default"),
      ros({{"auto", ros_bridge::RosMode::kAuto},
           {"off", ros_bridge::RosMode::kOff},
           {"required", ros_bridge::RosMode::kRequired}},
          ros_bridge::RosMode::kAuto),
      reference_frame("world", "a TF frame name: letters, digits, _ and /, not beginning with /",
                      IsFrameName),
      description("", "the name of a parameter, such as human_description", IsTopicNameOrEmpty),
      tf(Words({"flat", "tree", "off", "none"}), "flat"),
      joint_angle_source(Words({"computed", "streamed"}), "computed"),
      bind_ip("127.0.0.1"),
      http_port(8080, {0, 65535, "", false, "0: a free one, which is printed"}),
      history_minutes(10, {0, 60, "min"}),
      mark_names(
          "grasp,lift,place,release,step,slip,talk,pain,discard",
          "up to nine names with commas between, each of 1 to 40 characters with a letter or digit",
          AreMarkNames),
      stop_at(options::Number(0, {0, kLatestSecs, "s"})),
      body_opacity(BodyOpacity()),
      ghost_opacity(GhostOpacity()),
      pictures(true),
      camera(1),
      picture_size({kDefaultPictureWidth, kDefaultPictureHeight}),
      picture_rate_hz(kDefaultPictureRateHz, {kMinPictureRateHz, kMaxPictureRateHz, "Hz"}),
      ros_view(true),
      ros_view_camera(CamerasValue(1)),
      ros_view_size({kDefaultPictureWidth, kDefaultPictureHeight}),
      ros_view_rate_hz(kDefaultPictureRateHz, {kMinPictureRateHz, kMaxPictureRateHz, "Hz"}) {}

void ServeOptions::ListBridge(options::OptionList& option) {
  option.Group("The source");
  option("source", source, "source of the people: " + SourceKinds());
  option("from", from,
         "machines that may send: addresses and networks with commas in between, such as "
         "192.168.1.20,10.0.0.0/8; not given: all. Only for udp: and tcp:");
  option("udp_port", udp_port, "short for --source udp://:PORT");
  option.HasNoEffect("source", "with --udp_port", [this] { return *udp_port != 0; });
  option("loop", loop, "start a file again at its end");
  option("start_at", start_at,
         "time after the first sample of a recording at which it begins to play, s; with --loop "
         "the first round");
  option(
      "stamps", stamps,
      "time stamps of samples: fitted (arrival times smoothed by the sender's clock, which removes "
      "the jitter of the network) or arrival");
  option("stale_secs", stale_secs, "time without samples after which the stream is stale");
  option("alarms", alarms, "YAML file with the rules of alarms (docs/alarms.md), or default");
  person.List(option);
  loads.List(option);
  option.Remove(WrenchOptionNames());  // sensors of a live session come over ROS
  option.Group("ROS");
  option("ros", ros, "auto: publish when a master is reachable");
  option("reference_frame", reference_frame, "parent frame of all TF frames");
  option("description", description,
         "parameter that gets the URDF of the first person; default: robot_description, or "
         "human_description where another program has set that");
  option("tf", tf,
         "TF frames: flat (as xsens_mvn_ros), as a tree, off (the pelvis alone, for "
         "robot_state_publisher), or none");
  option("joint_angle_source", joint_angle_source,
         "joint angles in ~joint_states: computed from the poses, or streamed by MVN");
  option.Formerly("joint_states");
  option(
      "external_scale", external_scale,
      "factor of joint moments that are received over ROS; -1 for a program that sends reactions");
  for (const char* name :
       {"reference_frame", "description", "tf", "joint_angle_source", "external_scale"}) {
    option.HasNoEffect(name, "with --ros=off",
                       [this] { return *ros == ros_bridge::RosMode::kOff; });
  }
}

void ServeOptions::List(options::OptionList& option) {
  ListBridge(option);
  option.Group("The page");
  option("bind_ip", bind_ip,
         "address of the page; 0.0.0.0 opens it to the network (set --token_file)");
  option("http_port", http_port, "TCP port of the page");
  option(
      "token_file", token_file,
      "file with the operator's token of the page, its password: at least 16 letters, digits and "
      "-._~; a missing file is made with a random token. Required unless the page is served to "
      "this machine only");
  option("token", token,
         "the token itself, which the list of processes then shows; prefer --token_file or the "
         "environment variable KINESCOPE_TOKEN");
  option("viewer_token_file", viewer_token_file,
         "file with the token of viewers, who see everything and change nothing, beside the "
         "operator's token; a missing file is made with a random token");
  option("viewer_token", viewer_token,
         "the token of viewers itself, which the list of processes then shows; prefer "
         "--viewer_token_file or the environment variable KINESCOPE_VIEWER_TOKEN");
  option("tls_certificate", tls_certificate,
         "PEM file with a certificate for this machine, and those that confirm it: the page is "
         "then served encrypted, at https://. A file that changes is read again");
  option("tls_key", tls_key, "PEM file with the private key of --tls_certificate");
  option("base_path", base_path, "path under which a reverse proxy offers the page, such as /lab3");
  option("trusted_proxies", trusted_proxies,
         "machines whose X-Forwarded-For and X-Forwarded-Proto are believed, such as 127.0.0.1 or "
         "10.0.0.0/8; not given: none");
  option("history_minutes", history_minutes,
         "time that viewers of the page can look back; 0: none. Of a stream that needs more than "
         "500 MB for it, less is kept");
  option("mark_names", mark_names,
         "what the marks of the keys 1 to 9 of the page are called; needs a history");
  option("marks_file", marks_file,
         "JSON Lines file that marks are added to; default: a new file of each start, in "
         "~/.local/state/kinescope or the state folder of the service");
  option("recordings_folder", recordings_folder,
         "existing folder for what is recorded, rendered and reported from the page; default: "
         "recordings, in ~/.local/state/kinescope or the state folder of the service");
  option("stop_at", stop_at,
         "time after the first sample of a recording at which it stands still, s: all before it is "
         "read at once, and the page shows this moment; nothing is published to ROS");
  option.HasNoEffect("loop", "with --stop_at", [this] { return bool(stop_at); });
  option.HasNoEffect("start_at", "with --stop_at", [this] { return bool(stop_at); });
  option.HasNoEffect("ros", "with --stop_at",
                     [this] { return bool(stop_at) && *ros != ros_bridge::RosMode::kOff; });
  option.Group("Page and pictures");
  ListPeopleLook(option, figure, style, loads_shown, body_opacity);
  option("background", background,
         "background of the pictures that the server draws; theme: that of each viewer's page");
  trails.List(option);
  ListGhost(option, ghost, ghost_opacity);
  option("robot", robot, kRobotHelp);
  option("pictures", pictures, "whether the server draws pictures");
  option("camera", camera, "where the camera stands");
  camera_moves.List(option);
  option("rviz", rviz, kRvizHelp);
  option("picture_size", picture_size, "size of the live picture");
  option("picture_rate_hz", picture_rate_hz, "highest frame rate of the live picture");
  backend.List(option);
  option("marker_topics", marker_topics,
         "topics to show: visualization_msgs/Marker and MarkerArray, points, poses, paths, "
         "wrenches, laser scans, point clouds, maps, pictures of cameras and frames of TF "
         "(docs/ros.md)");
  option.Formerly("markers");
  option("ros_view", ros_view,
         "whether the ROS camera ~view is published (image_raw, camera_info and its frame); "
         "rendered while it has subscribers");
  option.Formerly("view");
  option("ros_view_camera", ros_view_camera, "camera of ~view; not given: that of --camera");
  option.Formerly("view_camera");
  option("ros_view_size", ros_view_size, "size of ~view");
  option.Formerly("view_size");
  option("ros_view_rate_hz", ros_view_rate_hz, "highest frame rate of ~view");
  option.Formerly("view_rate_hz");
  const auto has_no_graph = [this] { return *ros == ros_bridge::RosMode::kOff; };
  option.HasNoEffect("marker_topics", "with --ros=off, unless the source is a bag",
                     [this, has_no_graph] { return has_no_graph() && !IsBag(*source); });
  for (const char* name : {"ros_view", "ros_view_camera", "ros_view_size", "ros_view_rate_hz"}) {
    option.HasNoEffect(name, "with --ros=off", has_no_graph);
  }
  for (const char* name : {"ros_view_camera", "ros_view_size", "ros_view_rate_hz"}) {
    option.HasNoEffect(name, "with --ros_view=off", [this] { return !*ros_view; });
  }
  option.HasNoEffect("camera_tf", "with a named camera", [this] {
    return AreAllNamed(*camera) && (!ros_view_camera || AreAllNamed(*ros_view_camera));
  });
  // The page begins with a place, without pictures, too.
  for (const char* name : {"camera", "camera_tf", "fov"}) {
    option.HasNoEffect(name, "with --pictures=off, unless --camera is a place",
                       [this] { return !*pictures && AreAllNamed(*camera); });
  }
  for (const char* name :
       {"background", "projection", "orbit", "follow", "fit", "picture_size", "picture_rate_hz",
        "backend", "draw_limit_secs", "ros_view_camera", "ros_view_size", "ros_view_rate_hz"}) {
    option.HasNoEffect(name, "with --pictures=off", [this] { return !*pictures; });
  }
}

}  // namespace kinescope::app
