/// The options of `serve` and `bridge`.
#pragma once

#include <string>

#include "server/options/option_list.h"
#include "server/options/ros_names.h"
#include "server/picture/backend.h"
#include "server/picture/camera_options.h"
#include "server/picture/figure_value.h"
#include "server/picture/people_look.h"
#include "server/picture/rviz_option.h"
#include "server/picture/trail_options.h"
#include "server/picture/view_options.h"
#include "server/ros/bridge.h"
#include "server/scene/scene_options.h"
#include "server/source/open_source.h"

namespace kinescope::app {

/// A factor that is not 0.
class FactorValue : public options::ValueOf<double> {
 public:
  FactorValue() : ValueOf(1) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override;
  std::string Expected() const override;
  options::JsonKind json_kind() const override { return options::JsonKind::kNumber; }
};

using SecsOption = options::Optional<options::Number>;  // s

struct ServeOptions {
  ServeOptions();

  options::Text source, from;
  options::Whole udp_port;  // 0: as `source` says
  options::Flag loop;
  options::Choice<mvn::Stamps> stamps;
  options::Number stale_secs;
  SecsOption start_at;
  options::Text alarms;
  PersonOptions person;
  LoadOptions loads;
  // ROS
  options::Choice<ros_bridge::RosMode> ros;
  options::Text reference_frame, description;
  options::Choice<std::string> tf, joint_angle_source;
  FactorValue external_scale;
  // page and pictures
  options::Text bind_ip;
  options::Whole http_port;
  options::Text token, token_file, viewer_token, viewer_token_file;
  options::Text tls_certificate, tls_key, base_path, trusted_proxies;
  options::Number history_minutes;
  options::Text marks_file, mark_names, recordings_folder;
  SecsOption stop_at;
  // As messages name them: "~token", "file.yaml:3: token"; "": not given.
  std::string token_given_as, viewer_token_given_as;
  FigureValue figure;
  StyleValue style;
  LoadsShownValue loads_shown;  // --loads
  options::Number body_opacity;
  BackgroundValue background;
  TrailOptions trails;
  GhostValue ghost;
  options::Number ghost_opacity;
  RobotsValue robot;
  options::Switch pictures;
  CamerasValue camera;
  CameraOptions camera_moves;
  options::FilePath rviz;
  options::Size picture_size;
  options::Number picture_rate_hz;
  BackendOptions backend;
  ShownTopicsValue marker_topics;
  options::Switch ros_view;
  options::Optional<CamerasValue> ros_view_camera;
  options::Size ros_view_size;
  options::Number ros_view_rate_hz;

  /// With those of page and pictures.
  void List(options::OptionList& option);
  /// Those that make sense without page and pictures.
  void ListBridge(options::OptionList& option);
};

}  // namespace kinescope::app
