#include "server/picture/rviz_option.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <string>
#include <vector>

#include "server/picture/ros_names.h"
#include "server/picture/rviz_file.h"

namespace kinescope::app {
namespace {

using options::Channel;

// A view belongs together: the field of view of a file is not that of a camera that was given.
bool IsPartOfView(const std::string& option) {
  return option == "camera" || option == "fov" || option == "projection";
}

// `serve` shows what is on their topics, if it has ROS; otherwise they are named.
void ApplyTopics(const std::string& file, const std::vector<RvizPicture::Topic>& topics,
                 options::OptionList& list) {
  options::Option* const option = list.Find("marker_topics");
  const options::Option* const ros = list.Find("ros");
  const bool is_possible = option != nullptr && !(ros != nullptr && ros->value->ToText() == "off");
  std::vector<std::string> names;
  for (const RvizPicture::Topic& topic : topics) {
    const std::string place = fmt::format("{}:{}: ", file, topic.line);
    if (!is_possible) {
      if (!topic.is_marker) {
        spdlog::warn("{}{} is not drawn: only serve shows it, while it has ROS", place,
                     topic.display);
      }
    } else if (std::find(names.begin(), names.end(), topic.name) != names.end()) {
      continue;
    } else if (names.size() == kMaxMarkerTopics) {
      spdlog::warn("{}{} is not drawn: more than {} topics", place, topic.display, kMaxMarkerTopics);
    } else {
      names.push_back(topic.name);
    }
  }
  if (names.empty() || option->channel != Channel::kDefault) return;
  list.Set(*option, option->name, {fmt::format("{}", fmt::join(names, ",")), file + ": "},
           Channel::kFile);
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
    } else if (option->channel == Channel::kDefault &&
               !(has_camera && IsPartOfView(setting.option))) {
      const std::string origin = fmt::format("{}:{}: ", *file, setting.line);
      list.Set(*option, setting.option, {setting.text, origin}, Channel::kFile);
    }
  }
  ApplyTopics(*file, picture.topics, list);
  for (const std::string& remark : picture.remarks) spdlog::warn("{}", remark);
  if (!missing.empty()) spdlog::warn("{}: {}: only render takes this", *file, missing);
  list.CheckEffects();
}

}  // namespace kinescope::app
