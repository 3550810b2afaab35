/// Displays of an RViz configuration whose topic has messages that are shown as markers
/// (server/ros/shown_messages.h). Pure functions.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

namespace kinescope::app::rviz {

[[nodiscard]] bool IsTopicDisplay(const std::string& kind);

struct TopicStyle {
  std::string text;                  // as --marker_topics has it: "(color=#ff8800,size=0.1)", or ""
  std::vector<std::string> remarks;  // what RViz would draw otherwise
};
/// @pre IsTopicDisplay(kind)
TopicStyle StyleOf(const YAML::Node& display, const std::string& kind);

}  // namespace kinescope::app::rviz
