/// Implements `kinescope urdf picture`: renders any robot. One thread.
#pragma once

#include <string>
#include <vector>

#include "server/options/text.h"
#include "server/picture/backend.h"
#include "server/picture/view_options.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope::app {

/// NAME=RADIANS (or metres), once per joint.
class JointsValue : public options::ValueOf<urdf::JointPositions> {
 public:
  JointsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override { ParseAll(options::SplitItems(text)); }
  void ParseAll(const std::vector<std::string>& texts) override;
  bool is_repeatable() const override { return true; }
  std::string ToText() const override;
  std::string Expected() const override {
    return "NAME=RADIANS, or NAME=METRES of a sliding joint";
  }
};

struct UrdfPictureOptions {
  options::Text file, out;
  ViewOptions view;
  BackendOptions backend;
  options::Flag json;
  JointsValue joint;
  options::Texts package_path;  // folders

  void List(options::OptionList& option);
};

/// Renders the robot standing on the floor and writes options.out. Logs which meshes are replaced
/// by boxes. @throws SourceError, UsageError.
void DrawUrdf(const UrdfPictureOptions& options);

inline constexpr char kPackagePathHelp[] =
    "folder with ROS packages, for package:// names; searched before $ROS_PACKAGE_PATH; may be "
    "repeated";

}  // namespace kinescope::app
