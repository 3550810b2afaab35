/// The options of `serve` and `bridge`.
#pragma once

#include <string>

#include "server/picture/backend.h"
#include "server/picture/camera_man.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_options.h"
#include "server/source/open_source.h"

namespace kinescope::app {

struct ServeOptions {
  std::string source = "udp://:9763";
  int udp_port = 0;
  bool loop = false;
  std::string stamps = "fitted";
  double stale_secs = 0.5;
  PersonOptions person;
  LoadOptions loads;
  // ROS
  std::string ros = "auto";
  std::string reference_frame = "world";
  std::string tf = "flat";
  std::string joint_states = "computed";
  double external_scale = 1;
  // page and pictures
  std::string bind_ip = "127.0.0.1";
  int http_port = 8080;
  std::string token;
  std::string pictures = "on";
  std::string camera = "three_quarter";
  CameraOptions camera_moves;
  std::string picture_size = "1280x720";
  double picture_rate_hz = 30;
  BackendOptions backend;
  std::string markers;
  std::string view = "on";
  std::string view_camera;
  std::string view_size = "1280x720";
  double view_rate_hz = 30;

  template <class Option>
  void Visit(Option&& option) {
    VisitBridge(option);
    option("bind_ip", bind_ip,
           "address of the page; 0.0.0.0 lets the whole network in (set token)");
    option("http_port", http_port, "TCP port of the page; 0 takes a free one and prints it");
    option("token", token, "what a browser must bring; needed for any address but this machine's");
    option("pictures", pictures, "on or off: the server's own pictures");
    option("camera", camera, kCameraKinds);
    camera_moves.Visit(option);
    option("picture_size", picture_size, "of the live picture, px");
    option("picture_rate_hz", picture_rate_hz, "most pictures a second, whatever comes in");
    backend.Visit(option);
    option("markers", markers,
           "topics of other programs' markers that are to be seen, visualization_msgs/Marker or "
           "MarkerArray: /walls,/plan");
    option("view", view,
           "on or off: ~view/image_raw, ~view/camera_info and the camera's frame over ROS, drawn "
           "while somebody listens");
    option("view_camera", view_camera,
           "camera of that view, whatever the page shows; not given: as camera");
    option("view_size", view_size, "of that view, px");
    option("view_rate_hz", view_rate_hz, "most pictures of that view a second");
  }

  /// Those that make sense without page and pictures.
  template <class Option>
  void VisitBridge(Option&& option) {
    option("source", source, kSourceKinds);
    option("udp_port", udp_port, "short for source udp://:PORT; 0: as source says");
    option("loop", loop, "start a file over when it ends");
    option("stamps", stamps,
           "fitted (arrival smoothed onto the suit's clock, so that the network does not shake "
           "velocities) or arrival");
    option("stale_secs", stale_secs, "so long without a sample is shown as stale");
    person.Visit(option);
    loads.Visit(option);
    option("ros", ros, "auto (whenever a master is there), off, or required");
    option("reference_frame", reference_frame, "parent frame of every TF");
    option("tf", tf, "flat (as xsens_mvn_ros), tree or off");
    option("joint_states", joint_states, "computed from the poses, or streamed (type 20)");
    option("external_scale", external_scale,
           "multiplies joint moments that come over ROS; -1 for a program that means the reaction");
  }
};

// All: @throws UsageError naming option, value and what was expected.
ros_bridge::BridgeConfig ToBridgeConfig(const ServeOptions& options);
ros_bridge::RosMode ToRosMode(const std::string& ros);
mvn::Stamps ToStamps(const std::string& stamps);

}  // namespace kinescope::app
