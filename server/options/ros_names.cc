#include "server/options/ros_names.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include "core/system/starts_with.h"
#include "server/options/text.h"

namespace kinescope::app {
namespace {

constexpr double kFarthestGrid = 1000;    // m
constexpr double kLeastPaneWidth = 0.05;  // of an image, of the width of a picture

bool IsName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '/';
  });
}

// "by=z", "axis=message", "from=0", "to=2.5", "low=#000000", "high=#ffffff", "rainbow=inverted" of
// points.
bool TakeScale(const std::string& key, const std::string& text, PointScale& scale) {
  if (key == "by") {
    scale.by = text;
    return IsFieldName(text);
  }
  if (key == "axis") {
    scale.is_in_message = text == "message";
    return scale.is_in_message || text == "scene";
  }
  if (key == "rainbow") {
    scale.is_inverted = text == "inverted";
    return scale.is_inverted;
  }
  if (key == "low" || key == "high") {
    auto& color = key == "low" ? scale.low : scale.high;
    color = ColorFromHex(text);
    return color.has_value();
  }
  auto& bound = key == "from" ? scale.from : scale.to;
  bound = options::ParseNumber(text);
  return bound && std::abs(*bound) <= kLargestBound;
}

// "force=0.002", "torque=0", "torque_color=#255fff", "small=shown" of a wrench; "linear=1",
// "angular=0", "angular_color=#255fff" of a twist or an acceleration.
bool TakeArrows(const std::string& key, const std::string& text, WrenchArrows& arrows) {
  if (key == "torque_color" || key == "angular_color") {
    arrows.torque_color = ColorFromHex(text);
    return arrows.torque_color.has_value();
  }
  if (key == "small") {
    arrows.hides_small = text != "shown";
    return text == "shown" || text == "hidden";
  }
  const auto metres = options::ParseNumber(text);
  if (!metres) return false;
  (key == "force" || key == "linear" ? arrows.force_m : arrows.torque_m) = *metres;
  return *metres >= 0 && *metres <= kLongestArrow;
}

// "keep=100", "decay=5", "step=0.1", "turn=0.1".
bool TakeEarlier(const std::string& key, const std::string& text, EarlierMessages& earlier) {
  const auto number = options::ParseNumber(text);
  if (!number || *number < 0) return false;
  if (key == "keep") {
    const bool is_count = *number >= 1 && *number <= static_cast<double>(kMostKeptMessages) &&
                          *number == std::floor(*number);
    if (is_count) earlier.keep = static_cast<std::size_t>(*number);
    return is_count;
  }
  if (key == "decay") {
    earlier.decay_secs = *number;
    return *number <= kLongestDecay;
  }
  (key == "step" ? earlier.step_m : earlier.turn_rad) = *number;
  return *number <= kLargestStep;
}

// "covariance=1", "covariance_color=#cc33cc", "covariance_alpha=0.3" of a pose.
bool TakeCovariance(const std::string& key, const std::string& text, CovarianceStyle& covariance) {
  if (key == "covariance_color") {
    covariance.color = ColorFromHex(text);
    return covariance.color.has_value();
  }
  const bool is_alpha = key == "covariance_alpha";
  const auto number = options::ParseNumber(text);
  if (number) (is_alpha ? covariance.alpha : covariance.scale) = *number;
  return number && *number >= 0 && *number <= (is_alpha ? 1 : kLargestCovarianceScale);
}

// "turn_covariance=1", "turn_covariance_color=#ffff7f" or "=axes", "turn_covariance_alpha=0.5",
// "turn_covariance_offset=1" of a pose.
bool TakeTurnCovariance(const std::string& key, const std::string& text,
                        TurnCovarianceStyle& covariance) {
  if (key == "turn_covariance_color") {
    covariance.has_axis_colors = text == "axes";
    covariance.color = ColorFromHex(text);
    return covariance.has_axis_colors || covariance.color.has_value();
  }
  const auto number = options::ParseNumber(text);
  if (!number || *number < 0) return false;
  if (key == "turn_covariance_alpha") {
    covariance.alpha = *number;
    return *number <= 1;
  }
  if (key == "turn_covariance_offset") {
    covariance.offset_m = *number;
    return *number >= kSmallestShown && *number <= kLargestShown;
  }
  covariance.scale = *number;
  return *number <= kLargestCovarianceScale;
}

// "pose_size=0.3", "pose_width=0.03", "pose_color=#ff55ff" of a path.
bool TakePoses(const std::string& key, const std::string& text, PathPoses& poses) {
  if (key == "pose_color") {
    poses.color = ColorFromHex(text);
    return poses.color.has_value();
  }
  std::optional<double>& metres = key == "pose_width" ? poses.width_m : poses.size_m;
  metres = options::ParseNumber(text);
  return metres && *metres >= kSmallestShown && *metres <= kLargestShown;
}

// "head=0.3", "head_width=0.1", "shaft_width=0.05" of arrows of poses.
bool TakeArrow(const std::string& key, const std::string& text, ArrowStyle& arrow) {
  auto& metres = key == "head"         ? arrow.head_m
                 : key == "head_width" ? arrow.head_width_m
                                       : arrow.shaft_width_m;
  metres = options::ParseNumber(text);
  return metres && *metres >= kSmallestShown && *metres <= kLargestShown;
}

// "without=left|right": frames, or namespaces of a topic of markers.
bool TakeHidden(const std::string& text, std::vector<std::string>& hidden) {
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find('|', begin), text.size());
    if (end == begin) return false;
    hidden.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return true;
}

// "names=off", "text=0.1", "timeout=5" of all frames.
bool TakeFrames(const std::string& key, const std::string& text, FramesStyle& frames) {
  if (key == "text") {
    frames.name_m = options::ParseNumber(text);
    return frames.name_m && *frames.name_m >= kSmallestShown && *frames.name_m <= kLargestShown;
  }
  if (key == "timeout") {
    const auto secs = options::ParseNumber(text);
    if (secs) frames.timeout_secs = *secs;
    return secs && *secs >= 1 && *secs <= kLongestFrameTimeout;
  }
  (key == "names"  ? frames.has_names
   : key == "axes" ? frames.has_axes
                   : frames.has_arrows) = text == "on";
  return text == "on" || text == "off";
}

// "cells=20", "layers=2", "plane=xz", "at=0|0|-0.9" of a grid.
bool TakeGrid(const std::string& key, const std::string& text, GridStyle& grid) {
  if (key == "plane") {
    using Plane = GridStyle::Plane;
    grid.plane = text == "xz" ? Plane::kXz : text == "yz" ? Plane::kYz : Plane::kXy;
    return text == "xy" || text == "xz" || text == "yz";
  }
  if (key == "at") {
    std::size_t begin = 0;
    for (double& metres : grid.offset) {
      if (begin > text.size()) return false;
      const std::size_t end = std::min(text.find('|', begin), text.size());
      const auto number = options::ParseNumber(text.substr(begin, end - begin));
      if (!number || std::abs(*number) > kFarthestGrid) return false;
      metres = *number;
      begin = end + 1;
    }
    return begin == text.size() + 1;
  }
  const bool is_cells = key == "cells";
  const auto number = options::ParseNumber(text);
  const int most = is_cells ? kMostGridCells : kMostGridLayers;
  if (!number || *number < (is_cells ? 1 : 0) || *number > most) return false;
  (is_cells ? grid.cells : grid.layers) = static_cast<int>(*number);
  return *number == std::floor(*number);
}

// "scene=0.5", "pane=0.6", "cloud=on", "colors=/camera/image" of images.
bool TakeCamera(const std::string& key, const std::string& text, CameraStyle& camera) {
  if (key == "colors") {
    camera.color_topic = text;
    return IsTopicName(text);
  }
  if (key == "cloud") {
    camera.is_cloud = text == "on";
    return text == "on" || text == "off";
  }
  const auto share = options::ParseNumber(text);
  if (!share) return false;
  (key == "pane" ? camera.pane_width : camera.scene_opacity) = *share;
  return *share >= (key == "pane" ? kLeastPaneWidth : 0) && *share <= 1;
}

bool TakeShape(const std::string& text, ShownStyle& style) {
  style.has_axes = text == "axes";
  style.has_arrows = text == "arrows";
  style.has_spheres = text == "spheres";
  style.has_cubes = text == "cubes";
  return style.has_axes || style.has_arrows || style.has_spheres || style.has_cubes ||
         text == "arrow" || text == "squares";
}

// "color=#ff8800": false where it says nothing.
bool TakeStyle(const std::string& item, ShownStyle& style) {
  const auto parts = options::SplitAtLast(item, '=');
  if (!parts) return false;
  const auto& [key, text] = *parts;
  const auto is_one_of = [&key = key](std::initializer_list<const char*> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  if (key == "color") {
    style.color = ColorFromHex(text);
    return style.color.has_value();
  }
  if (key == "shape") return TakeShape(text, style);
  if (key == "scheme") {
    style.map_colors = text == "costmap" ? MapColors::kCostmap
                       : text == "raw"   ? MapColors::kRaw
                                         : MapColors::kMap;
    return text == "map" || style.map_colors != MapColors::kMap;
  }
  if (key == "updates" || key == "behind") {
    (key == "updates" ? style.has_updates : style.is_behind) = text == "on";
    return text == "on" || text == "off";
  }
  if (is_one_of(
          {"force", "torque", "torque_color", "linear", "angular", "angular_color", "small"})) {
    return TakeArrows(key, text, style.wrench);
  }
  if (is_one_of({"covariance", "covariance_color", "covariance_alpha"})) {
    return TakeCovariance(key, text, style.covariance);
  }
  if (is_one_of({"turn_covariance", "turn_covariance_color", "turn_covariance_alpha",
                 "turn_covariance_offset"})) {
    return TakeTurnCovariance(key, text, style.turn_covariance);
  }
  if (is_one_of({"scene", "pane", "cloud", "colors"})) return TakeCamera(key, text, style.camera);
  if (is_one_of({"head", "head_width", "shaft_width"})) return TakeArrow(key, text, style.arrow);
  if (key == "array") {
    style.has_array = text == "on";
    return text == "on" || text == "off";
  }
  if (is_one_of({"pose_size", "pose_width", "pose_color"}))
    return TakePoses(key, text, style.poses);
  if (key == "handles") {
    style.has_handles = text == "on";
    return text == "on" || text == "off";
  }
  if (key == "without") return TakeHidden(text, style.frames.hidden);
  if (is_one_of({"axes", "names", "arrows", "text", "timeout"})) {
    return TakeFrames(key, text, style.frames);
  }
  if (is_one_of({"cells", "layers", "plane", "at"})) return TakeGrid(key, text, style.grid);
  if (is_one_of({"keep", "decay", "step", "turn"})) return TakeEarlier(key, text, style.earlier);
  if (is_one_of({"by", "axis", "from", "to", "low", "high", "rainbow"})) {
    if (!style.scale) style.scale = PointScale{};
    return TakeScale(key, text, *style.scale);
  }
  if (key == "missing") {  // a frame
    style.stands_in_scene = true;
    style.is_told_missing = text == "origin";
    return text == "scene" || text == "origin";
  }
  const auto number = options::ParseNumber(text);
  if (key == "alpha" && number) {
    style.alpha = *number;
    return *number >= 0 && *number <= 1;
  }
  if (key == "pixels" && number) {
    style.size_px = *number;
    return *number >= kSmallestPixels && *number <= kLargestPixels;
  }
  if (key == "points" && number) {
    const bool is_count = *number >= 1 && *number <= static_cast<double>(kMostCloudPoints) &&
                          *number == std::floor(*number);
    if (is_count) style.most_points = static_cast<std::size_t>(*number);
    return is_count;
  }
  if ((key != "size" && key != "width") || !number) return false;
  (key == "size" ? style.size_m : style.width_m) = *number;
  return *number >= kSmallestShown && *number <= kLargestShown;
}

std::optional<ShownTopic> ParseTopic(const std::string& text) {
  ShownTopic topic;
  const std::size_t open = text.find('(');
  topic.name = text.substr(0, open);
  topic.leaves_out_others = text == kNoOtherTopics;
  if (topic.leaves_out_others) return topic;
  topic.is_grid = StartsWith(topic.name, kGridInFrame);
  topic.is_frame = topic.is_grid || StartsWith(topic.name, kAxesOfFrame);
  if (topic.is_frame) topic.name.erase(0, std::strlen(topic.is_grid ? kGridInFrame : kAxesOfFrame));
  const bool is_every_axis = topic.is_every_frame() && !topic.is_grid;
  const bool is_good = topic.is_frame
                           ? topic.name.empty() || is_every_axis || IsFrameName(topic.name)
                           : IsTopicName(topic.name);
  if (!is_good) return std::nullopt;
  if (open == std::string::npos) return topic;
  if (text.back() != ')') return std::nullopt;
  for (const std::string& item :
       options::SplitItems(text.substr(open + 1, text.size() - open - 2))) {
    if (!TakeStyle(item, topic.style)) return std::nullopt;
  }
  const std::vector<std::string>& hidden = topic.style.frames.hidden;
  const bool are_names = !topic.is_frame || std::all_of(hidden.begin(), hidden.end(), IsFrameName);
  if (!are_names) return std::nullopt;
  const GridStyle& grid = topic.style.grid;
  if (grid.layers > 0 && grid.cells > kMostLayeredCells) return std::nullopt;
  return topic;
}

}  // namespace

bool IsTopicName(const std::string& text) {
  const bool is_private = !text.empty() && text.front() == '~';
  const std::string name = is_private ? text.substr(1) : text;
  return IsName(name) && name.find_first_not_of('/') != std::string::npos &&
         (name.front() == '/' || std::isalpha(static_cast<unsigned char>(name.front())) != 0);
}

bool IsTopicNameOrEmpty(const std::string& text) { return text.empty() || IsTopicName(text); }

bool IsFieldName(const std::string& text) {
  constexpr std::size_t kLongest = 64;  // bytes
  return IsName(text) && text.size() <= kLongest && text.find('/') == std::string::npos;
}

bool IsFrameName(const std::string& text) { return IsName(text) && text.front() != '/'; }

void ShownTopicsValue::Parse(const std::string& text) {
  std::vector<ShownTopic> topics;
  for (const std::string& item : options::SplitItems(text)) {
    std::optional<ShownTopic> topic = ParseTopic(item);
    if (!topic || topics.size() == kMostShownTopics) RefuseText();
    topics.push_back(std::move(*topic));
  }
  value_ = std::move(topics);
  text_ = text;
}

std::string ShownTopicsValue::Expected() const {
  return "up to " + std::to_string(kMostShownTopics) +
         " topics with commas between, such as /walls,/cloud(color=#ff8800,alpha=0.5,size=0.02),"
         "/goal(shape=axes),/scan(by=z,from=0,to=2) (size in m), tf:* for all frames of TF, or "
         "grid: for a grid of 10 x 10 m";
}

}  // namespace kinescope::app
