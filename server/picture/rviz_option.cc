#include "server/picture/rviz_option.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "core/system/starts_with.h"
#include "server/options/ros_names.h"
#include "server/picture/rviz_file.h"
#include "server/picture/rviz_values.h"
#include "server/source/open_source.h"
#include "urdf/segments.h"

namespace kinescope::app {
namespace {

using options::Channel;
using rviz::Quoted;

// A view belongs together: the field of view of a file is not that of a camera that was given.
bool IsPartOfView(const std::string& option) {
  return option == "camera" || option == "fov" || option == "projection" || option == "camera_tf";
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

// Without how it is drawn.
std::string ModelOf(const RvizPicture::Robot& robot) {
  return robot.option.substr(0, robot.option.find('('));
}

// Of the graph: what a person's description is, the server finds out.
void ApplyRobots(const std::string& file, const std::vector<RvizPicture::Robot>& robots,
                 options::OptionList& list) {
  options::Option* const option = list.Find("robot");
  if (option == nullptr || robots.empty()) return;
  if (option->channel != Channel::kDefault) {
    for (const RvizPicture::Robot& robot : robots) {
      if (robot.option == ModelOf(robot) && robot.option.find("@tf:") == std::string::npos)
        continue;
      spdlog::info("{}:{}: {}: Alpha and TF Prefix are those of --robot (FILE.urdf@tf:PREFIX)",
                   file, robot.line, robot.display);
    }
    return;
  }
  std::vector<std::string> texts;
  if (HasGraph(list)) {
    std::set<std::string> models;
    for (const RvizPicture::Robot& robot : robots) {
      if (models.insert(ModelOf(robot)).second) texts.push_back(robot.option);
    }
    list.Set(*option, option->name, {"", file + ": ", texts}, Channel::kFile);
    return;
  }
  // The first model is that of the people.
  spdlog::info("{}:{}: {} is taken for the people; if it is a robot, give its URDF as --robot",
               file, robots.front().line, robots.front().display);
  for (std::size_t i = 1; i < robots.size(); ++i) {
    if (ModelOf(robots[i]) == ModelOf(robots.front())) continue;
    spdlog::warn("{}:{}: {} is another model: give the URDF of a robot as --robot", file,
                 robots[i].line, robots[i].display);
  }
}

// Of a topic that is shown in two ways, both are.
std::string NameOf(const RvizPicture::Topic& topic) {
  const std::string name = StartsWith(topic.name, "/") ? topic.name.substr(1) : topic.name;
  return name + topic.style;
}

// What is drawn in its place, if anything, where the source has no topics.
void NameWithoutTopics(const std::string& place, const RvizPicture::Topic& topic) {
  constexpr char kWhere[] = "the source has no topics (a bag has, and serve with ROS)";
  if (topic.is_floor && !topic.floor_differs) {
    spdlog::info("{}{}: the floor of the scene is drawn in its place", place, topic.display);
  } else if (topic.is_floor) {
    spdlog::warn("{}{} lies elsewhere than the floor, which is drawn in its place: {}", place,
                 topic.display, kWhere);
  } else if (topic.is_every_frame) {
    spdlog::warn(
        "{}{}: of frames, only the axes of people's links are drawn: the source has no TF (a bag "
        "has, and serve with ROS)",
        place, topic.display);
  } else if (!topic.is_of_people) {
    spdlog::warn("{}{} is not drawn: {}", place, topic.display, kWhere);
  }
}

// Shown where there are topics; otherwise they are named.
void ApplyTopics(const std::string& file, const std::vector<RvizPicture::Topic>& topics,
                 options::OptionList& list) {
  options::Option* const option = list.Find("marker_topics");
  const bool is_possible = option != nullptr && HasTopics(list);
  std::vector<std::string> names;
  std::vector<std::string> items = {kNoOtherTopics};  // RViz hears what its displays name
  const bool has_floor_of_page = list.Find("floor") == nullptr;  // each viewer of `serve` has one
  for (const RvizPicture::Topic& topic : topics) {
    const std::string place = fmt::format("{}:{}: ", file, topic.line);
    if (!is_possible) {
      NameWithoutTopics(place, topic);
      continue;
    }
    const bool is_known = std::find(names.begin(), names.end(), NameOf(topic)) != names.end();
    const bool is_floor_of_page = has_floor_of_page && topic.is_floor && !topic.floor_differs;
    if (is_known || is_floor_of_page) continue;
    if (items.size() == kMostShownTopics) {
      spdlog::warn("{}{} is not drawn: more than {} topics", place, topic.display, names.size());
    } else {
      names.push_back(NameOf(topic));
      items.push_back(topic.name + topic.style);
    }
  }
  if (!is_possible || option->channel != Channel::kDefault) return;
  list.Set(*option, option->name, {fmt::format("{}", fmt::join(items, ",")), file + ": "},
           Channel::kFile);
}

// The fixed frame of the file is that of the scene, or a camera that stands in it goes with it.
class Frames {
 public:
  Frames(const std::string& file, const RvizPicture& picture, options::OptionList& list)
      : file_(file), picture_(picture), list_(list) {
    const options::Option* option = list.Find("reference_frame");
    is_of_source_ = option == nullptr || !list.HasEffect("reference_frame");
    if (!is_of_source_) ours_ = option->value->ToText();
  }

  /// `has_camera`: one that does not come from the file.
  void Apply(bool has_camera) {
    const RvizPicture::Target& target = picture_.target;
    const bool is_fixed_ours = picture_.fixed_frame == ours_;
    bool is_in_fixed = is_fixed_ours;  // as RViz has it
    if (!target.frame.empty() && target.frame != ours_) {
      // As RViz has it: where its target is, with the axes of the fixed frame.
      const bool has_axes = target.turn.empty() && !is_fixed_ours && HasTopics(list_) &&
                            IsFrameName(picture_.fixed_frame);
      const bool is_there = Follow(
          target.frame, has_axes ? ":axes=" + picture_.fixed_frame : target.turn, has_camera);
      is_in_fixed = is_in_fixed || is_there;
    } else if (target.frame.empty() && !is_fixed_ours) {
      is_in_fixed = Follow(picture_.fixed_frame, ":pose", has_camera);
    }
    if (!is_fixed_ours) Warn(is_in_fixed);
  }

 private:
  // False: the camera stands.
  bool Follow(const std::string& frame, const std::string& turn, bool has_camera) {
    options::Option* const option = list_.Find("camera_tf");
    if (has_camera || option == nullptr || option->channel != Channel::kDefault) return false;
    if (!list_.HasEffect("camera_tf")) return false;
    const bool is_name = IsFrameName(frame), is_there = HasTopics(list_) || IsOfPerson(frame);
    if (is_name && is_there) {
      list_.Set(*option, option->name,
                {frame + turn, fmt::format("{}:{}: ", file_, picture_.target.line)},
                Channel::kFile);
      if (frame != kUsualFrameOfRviz) {
        spdlog::info("{}:{}: the camera is to go with the frame {}", file_, picture_.target.line,
                     Quoted(frame));
      }
      return true;
    }
    if (!picture_.target.frame.empty()) {
      spdlog::warn(
          "{}:{}: the view's Target Frame {} is not followed: {}; the camera stands as if it were "
          "at the origin",
          file_, picture_.target.line, Quoted(frame),
          is_name ? "the source has no frames but those of people (a bag has, and serve with ROS)"
                  : "it is no name of a frame");
    }
    return false;
  }

  // "skeleton_pelvis"; if there is no such person, the scene says it.
  static bool IsOfPerson(const std::string& frame) {
    return std::any_of(urdf::kSegments.begin(), urdf::kSegments.end(), [&](const auto& segment) {
      const std::string end = "_" + std::string(segment.link_name);
      return frame.size() > end.size() &&
             frame.compare(frame.size() - end.size(), std::string::npos, end) == 0;
    });
  }

  void Warn(bool is_in_fixed) {
    if (picture_.fixed_frame == kUsualFrameOfRviz) return;
    // With topics a picture has grids in place of the floor.
    if (is_in_fixed && HasTopics(list_) && list_.Find("floor") != nullptr) return;
    const std::string what =
        is_in_fixed ? "the camera stands in it; the floor, and what is kept of earlier messages, "
                      "stand in"
                    : "the scene is drawn in";
    // That of a bag is known once it is read.
    const std::string frame = !is_of_source_     ? "'" + ours_ + "'"
                              : HasTopics(list_) ? "the frame of the bag"
                                                 : "'" + ours_ + "', the frame of its source";
    const std::string then = is_of_source_ ? ""
                             : is_in_fixed
                                 ? ", or in the root of TF where that has none"
                                 : "; if the people are in that frame, give --reference_frame";
    spdlog::warn("{}:{}: Fixed Frame {}: {} {}{}", file_, picture_.fixed_frame_line,
                 Quoted(picture_.fixed_frame), what, frame, then);
  }

  const std::string& file_;
  const RvizPicture& picture_;
  options::OptionList& list_;
  std::string ours_ = "world";
  bool is_of_source_ = false;
};

}  // namespace

void ApplyRviz(const options::FilePath& file, int height_px, options::OptionList& list) {
  if (!file.IsGiven()) return;
  const RvizPicture picture = ReadRvizFile(*file, height_px);
  const options::Option* const camera = list.Find("camera");
  const bool has_camera = camera != nullptr && camera->channel != Channel::kDefault;
  const options::Option* const topics = list.Find("marker_topics");
  const bool takes_topics =
      topics != nullptr && topics->channel == Channel::kDefault && HasTopics(list);
  std::string missing;
  for (const RvizPicture::Setting& setting : picture.settings) {
    if (setting.option == "show" && HasTopics(list)) continue;  // the topics have the frames
    options::Option* const option = list.Find(setting.option);
    if (option == nullptr && setting.option == "theme" && list.Find("background") != nullptr) {
      continue;  // it follows from the background
    }
    if (option == nullptr) {
      missing += (missing.empty() ? "" : ", ") + setting.option;
    } else if (option->channel == Channel::kDefault && list.HasEffect(setting.option) &&
               !(has_camera && IsPartOfView(setting.option))) {
      const std::string origin = fmt::format("{}:{}: ", *file, setting.line);
      const bool is_drawn_grid = setting.option == "floor" && takes_topics;
      list.Set(*option, setting.option, {is_drawn_grid ? "off" : setting.text, origin},
               Channel::kFile);
    }
  }
  ApplyRobots(*file, picture.robots, list);
  ApplyTopics(*file, picture.topics, list);
  Frames(*file, picture, list).Apply(has_camera);
  for (const std::string& remark : picture.remarks) spdlog::warn("{}", remark);
  if (!missing.empty()) {
    spdlog::info("{}: what it has of {} is for render; here each viewer chooses on the page", *file,
                 missing);
  }
  list.CheckEffects();
}

}  // namespace kinescope::app
