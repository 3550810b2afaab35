/// The options of the commands. One list each: `Visit` names every option once, and --flag, ~param,
/// YAML key and --help all come from it (option_list.h).
#pragma once

#include <optional>
#include <string>

#include "server/app/backend.h"
#include "server/app/camera_man.h"
#include "server/app/open_source.h"
#include "server/loads/load_settings.h"

namespace kinescope::app {

/// Who is in the suit, and how they are shown.
struct PersonOptions {
  std::string model_name = "skeleton";
  // What nobody gave is assumed, and is said to be wherever it is shown.
  std::optional<std::string> sex;
  std::optional<double> mass, height;
  std::string body_table = urdf::Name(urdf::BodyDescription().table);
  std::string extra_mass;
  std::string figure = "smooth";
  std::string tool;
  std::string mesh_units = "m";
  std::string mesh_up = "z";
  std::string mesh_scale = "fit";
  std::string mesh_frame = "auto";

  template <class Option>
  void Visit(Option&& option) {
    option("model_name", model_name, "prefix of links, joints and TF frames");
    option("sex", sex, "male or female: body table and strength; not given: male is assumed");
    option("mass", mass, "body mass, kg; not given: 75 (male) or 62 (female) is assumed");
    option("height", height,
           "stature, m, until the suit tells its own segment lengths; not given: 1.75 is assumed");
    option("body_table", body_table,
           "masses of segments by: de_leva, winter, dumas or iit (docs/loads.md)");
    option("extra_mass", extra_mass,
           "worn or carried: SEGMENT:KG or SEGMENT:KG@X,Y,Z (m, in the link's frame), several with "
           "commas between, such as head:1.5,t8:8@-0.15,0,0.1");
    option(
        "figure", figure,
        "smooth, primitive (boxes, cylinders, spheres) or mesh:FOLDER (your own STL, DAE, OBJ or "
        "GLB files, named after segments, such as RightForeArm.stl)");
    option("tool", tool,
           "mesh of what is held: right:FILE or left:FILE (STL, DAE, OBJ or GLB), its origin at "
           "the grip, or FILE@X,Y,Z or FILE@X,Y,Z,ROLL,PITCH,YAW (m and rad, in the hand's link "
           "frame), with ; between two. What it weighs, and where, is told by hand");
    option("mesh_units", mesh_units, "of your own STL and OBJ files: m, cm or mm");
    option("mesh_up", mesh_up, "likewise, the axis that points up: z or y");
    option("mesh_scale", mesh_scale,
           "fit (meshes stretched along their segments to the person's own lengths) or none");
    option(
        "mesh_frame", mesh_frame,
        "how arm meshes lie: segment (along y, T-pose), link (along -z, N-pose) or auto (as they "
        "are longer)");
  }
};

/// What the loads in the joints are computed from, and what they are measured against.
struct LoadOptions {
  double capacity_factor = loads::Strength().factor;
  std::string capacity_percentile = "50";
  std::string load_metric = Name(loads::LoadSettings().metric);
  std::string load_mode = "dynamic";
  std::string class_limits = "0.3,0.6";
  std::string hand;
  double filter_hz = loads::MotionFilter::Settings().cutoff_hz;
  std::string lumbar_compression = "on";

  template <class Option>
  void Visit(Option&& option) {
    option("capacity_factor", capacity_factor,
           "this person's strength over that of the population, 0.1 to 5");
    option("capacity_percentile", capacity_percentile,
           "strength of the population to measure against: 5, 50 or 95 percent are weaker");
    option("load_metric", load_metric,
           "total, overload (what the load in the hands adds), norm (|moment|, without directions) "
           "or external (as another program computed it)");
    option("load_mode", load_mode, "dynamic (accelerations take part) or static");
    option("class_limits", class_limits,
           "of capacity: above the first a load is medium (orange), above the second high (red), "
           "while it rises");
    option("hand", hand,
           "what the hands hold: right:KG, left:KG or both:KG, right:KG@X,Y,Z (m, in the hand's "
           "link frame) for another place than the grip, several with commas between; none: "
           "nothing, for certain; not given: not known");
    option("filter_hz", filter_hz, "cut-off of the low-pass for accelerations, 3 to 10 Hz");
    option("lumbar_compression", lumbar_compression,
           "on or off: L5/S1 shows the worse of its moment and its compression");
  }
};

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

}  // namespace kinescope::app
