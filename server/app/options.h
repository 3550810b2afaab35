/// The options of the commands. One list each: `Visit` names every option once, and --flag, ~param,
/// YAML key and --help all come from it (option_list.h).
#pragma once

#include <string>

#include "server/app/open_source.h"

namespace kinescope::app {

/// Who is in the suit, and how they are shown.
struct PersonOptions {
  std::string model_name = "skeleton";
  std::string sex = "male";
  double mass = 0;  // 0: not given
  double height = 1.75;
  std::string figure = "smooth";
  std::string mesh_units = "m";
  std::string mesh_up = "z";
  std::string mesh_scale = "fit";
  std::string mesh_frame = "auto";

  template <class Option>
  void Visit(Option&& option) {
    option("model_name", model_name, "prefix of links, joints and TF frames");
    option("sex", sex, "male or female: body table and strength");
    option("mass", mass, "body mass, kg; 0: not known, 75 (male) or 62 (female) is assumed");
    option("height", height, "stature, m, until the suit tells its own segment lengths");
    option("figure", figure,
           "smooth, primitive (boxes, cylinders, spheres) or mesh:FOLDER (your own STL, DAE, OBJ or "
           "GLB files, named after segments, such as RightForeArm.stl)");
    option("mesh_units", mesh_units, "of mesh:FOLDER's STL and OBJ files: m, cm or mm");
    option("mesh_up", mesh_up, "likewise, the axis that points up: z or y");
    option("mesh_scale", mesh_scale,
           "fit (meshes stretched along their segments to the person's own lengths) or none");
    option("mesh_frame", mesh_frame,
           "how arm meshes lie: segment (along y, T-pose), link (along -z, N-pose) or auto (as they "
           "are longer)");
  }
};

struct ServeOptions {
  std::string source = "udp://:9763";
  int udp_port = 0;
  bool loop = false;
  std::string stamps = "fitted";
  double stale_secs = 0.5;
  PersonOptions person;
  // ROS
  std::string ros = "auto";
  std::string reference_frame = "world";
  std::string tf = "flat";
  std::string joint_states = "computed";
  // page and pictures
  std::string bind_ip = "127.0.0.1";
  int http_port = 8080;
  std::string token;
  std::string pictures = "on";
  std::string camera = "three_quarter";
  std::string picture_size = "1280x720";
  double picture_rate_hz = 30;

  template <class Option>
  void Visit(Option&& option) {
    VisitBridge(option);
    option("bind_ip", bind_ip,
           "address of the page; 0.0.0.0 lets the whole network in (set token)");
    option("http_port", http_port, "TCP port of the page; 0 takes a free one and prints it");
    option("token", token, "what a browser must bring; needed for any address but this machine's");
    option("pictures", pictures, "on or off: the server's own pictures");
    option("camera", camera,
           "camera of the live picture: front back left right top iso three_quarter");
    option("picture_size", picture_size, "of the live picture, px");
    option("picture_rate_hz", picture_rate_hz, "most pictures a second, whatever comes in");
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
    option("ros", ros, "auto (whenever a master is there), off, or required");
    option("reference_frame", reference_frame, "parent frame of every TF");
    option("tf", tf, "flat (as xsens_mvn_ros), tree or off");
    option("joint_states", joint_states, "computed from the poses, or streamed (type 20)");
  }
};

}  // namespace kinescope::app
