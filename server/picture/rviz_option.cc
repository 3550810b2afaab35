#include "server/picture/rviz_option.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/system/utf8.h"
#include "server/options/ros_names.h"
#include "server/picture/rviz_file.h"
#include "server/source/open_source.h"

namespace kinescope::app {
namespace {

using options::Channel;

// A view belongs together: the field of view of a file is not that of a camera that was given.
bool IsPartOfView(const std::string& option) {
  return option == "camera" || option == "fov" || option == "projection";
}

bool HasGraph(options::OptionList& list) {
  const options::Option* const ros = list.Find("ros");
  return ros != nullptr && ros->value->ToText() != "off";
}

// The topics of a ROS graph, or of a bag.
bool HasTopics(options::OptionList& list) {
  const options::Option* const source = list.Find("source");
  if (HasGraph(list) || source == nullptr) return HasGraph(list);
  const std::vector<std::string> sources = source->value->ToTexts();
  return !sources.empty() && std::all_of(sources.begin(), sources.end(), IsBag);
}

// Of the graph: what a person's description is, the server finds out.
void ApplyRobots(const std::string& file, const std::vector<RvizPicture::Robot>& robots,
                 options::OptionList& list) {
  options::Option* const option = list.Find("robot");
  if (option == nullptr || option->channel != Channel::kDefault || robots.empty()) return;
  std::vector<std::string> texts;
  if (HasGraph(list)) {
    for (const RvizPicture::Robot& robot : robots) texts.push_back(robot.option);
    list.Set(*option, option->name, {"", file + ": ", texts}, Channel::kFile);
    return;
  }
  // The first model is that of the people.
  for (std::size_t i = 1; i < robots.size(); ++i) {
    spdlog::warn("{}:{}: {} is another model: give the URDF of a robot as --robot", file,
                 robots[i].line, robots[i].display);
  }
}

// Shown where there are topics; otherwise they are named.
void ApplyTopics(const std::string& file, const std::vector<RvizPicture::Topic>& topics,
                 options::OptionList& list) {
  options::Option* const option = list.Find("marker_topics");
  const bool is_possible = option != nullptr && HasTopics(list);
  std::vector<std::string> names, items;
  for (const RvizPicture::Topic& topic : topics) {
    const std::string place = fmt::format("{}:{}: ", file, topic.line);
    if (!is_possible) {
      if (!topic.is_marker) {
        spdlog::warn("{}{} is not drawn: the source has no topics (a bag has, and serve with ROS)",
                     place, topic.display);
      }
    } else if (std::find(names.begin(), names.end(), topic.name) != names.end()) {
      continue;
    } else if (names.size() == kMostShownTopics) {
      spdlog::warn("{}{} is not drawn: more than {} topics", place, topic.display,
                   kMostShownTopics);
    } else {
      names.push_back(topic.name);
      items.push_back(topic.name + topic.style);
    }
  }
  if (items.empty() || option == nullptr || option->channel != Channel::kDefault) return;
  list.Set(*option, option->name, {fmt::format("{}", fmt::join(items, ",")), file + ": "},
           Channel::kFile);
}

// Of a graph it is the frame of the scene, or the camera of the file stands elsewhere.
void CheckFixedFrame(const std::string& file, const RvizPicture& picture,
                     options::OptionList& list) {
  constexpr char kUsual[] = "map";  // of RViz, with or without a frame of this name
  const options::Option* option = list.Find("reference_frame");
  if (option != nullptr && !list.HasEffect("reference_frame")) option = nullptr;
  const std::string ours = option == nullptr ? "world" : option->value->ToText();
  if (picture.fixed_frame == ours || picture.fixed_frame == kUsual) return;
  spdlog::warn("{}:{}: Fixed Frame '{}': the scene is drawn in '{}'{}", file,
               picture.fixed_frame_line, PrintableLine(picture.fixed_frame.substr(0, 100)), ours,
               option == nullptr ? ", the frame of its source"
                                 : "; if the people are in that frame, give --reference_frame");
}

}  // namespace

void ApplyRviz(const options::FilePath& file, int height_px, options::OptionList& list) {
  if (!file.IsGiven()) return;
  const RvizPicture picture = ReadRvizFile(*file, height_px);
  const options::Option* const camera = list.Find("camera");
  const bool has_camera = camera != nullptr && camera->channel != Channel::kDefault;
  std::string missing;
  for (const RvizPicture::Setting& setting : picture.settings) {
    options::Option* const option = list.Find(setting.option);
    if (option == nullptr) {
      missing += (missing.empty() ? "" : ", ") + setting.option;
    } else if (option->channel == Channel::kDefault && list.HasEffect(setting.option) &&
               !(has_camera && IsPartOfView(setting.option))) {
      const std::string origin = fmt::format("{}:{}: ", *file, setting.line);
      list.Set(*option, setting.option, {setting.text, origin}, Channel::kFile);
    }
  }
  ApplyRobots(*file, picture.robots, list);
  ApplyTopics(*file, picture.topics, list);
  CheckFixedFrame(*file, picture, list);
  for (const std::string& remark : picture.remarks) spdlog::warn("{}", remark);
  if (!missing.empty()) spdlog::warn("{}: {}: only render takes this", *file, missing);
  list.CheckEffects();
}

}  // namespace kinescope::app
