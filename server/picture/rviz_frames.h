/// Displays of an RViz configuration that have no topic: Grid, Axes and TF, which stand in frames
/// of TF. Pure functions.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <tl/expected.hpp>
#include <vector>

namespace kinescope::app::rviz {

struct FrameDisplay {
  std::string name;             // as --marker_topics has it, such as "grid:world"
  std::string style;            // as there, such as "(size=0.5)", or ""
  bool is_every_frame = false;  // TF
  bool is_floor = false;        // a level grid
  bool floor_differs = false;   // which is not in the origin of the fixed frame
  bool has_axes = false;        // TF that shows them
};
[[nodiscard]] bool IsFrameDisplay(const std::string& kind);

/// Or why it cannot be drawn. What RViz draws otherwise is added to `remarks`.
/// @pre IsFrameDisplay(kind)
/// @param fixed_frame  without a slash before it
tl::expected<FrameDisplay, std::string> FrameDisplayOf(const YAML::Node& display,
                                                       const std::string& kind,
                                                       const std::string& fixed_frame,
                                                       std::vector<std::string>& remarks);

}  // namespace kinescope::app::rviz
