#include "server/picture/rviz_topics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/suit_colors.h"
#include "server/options/ros_names.h"
#include "server/options/text.h"
#include "server/picture/rviz_values.h"

namespace kinescope::app::rviz {
namespace {

// Where they are: Odometry has some of them below its property "Shape".
struct ShownProperties {
  const char* kind;
  const char* color = nullptr;            // null: of points, by "Color Transformer"
  std::array<const char*, 2> sizes = {};  // their sum
  // The sizes count unless this property, which is usually `usually`, is `not_if`.
  const char* only_if = nullptr;
  const char* not_if = "";
  const char* usually = "";
  bool has_shape = false;  // "Shape" says Axes, in place of an arrow
};
constexpr char kNone[] = "";  // no property has this name
constexpr char kDepthDisplay[] = "rviz/DepthCloud";
constexpr char kEffortDisplay[] = "rviz/Effort";
constexpr ShownProperties OfPoints(const char* kind) {
  return {kind, nullptr, {"Size (m)"}, "Style", "Points", "Flat Squares"};
}
constexpr ShownProperties kTopicDisplays[] = {
    {"rviz/PointStamped", "Color", {"Radius"}},
    {"rviz/Pose", "Color", {}, nullptr, "", "", true},
    {"rviz/PoseWithCovariance", "Color", {}, nullptr, "", "", true},
    {"rviz/Odometry", "Color", {}, nullptr, "", "", true},
    {"rviz/PoseArray", "Color", {"Arrow Length"}, nullptr, "", "", true},
    {"rviz/Path", "Color", {"Line Width"}, "Line Style", "Lines", "Lines"},
    {"rviz/Polygon", "Color"},
    {"rviz/GridCells", "Color"},
    {"rviz/Map", kNone},
    OfPoints("rviz/LaserScan"),
    OfPoints("rviz/PointCloud"),
    OfPoints("rviz/PointCloud2"),
    OfPoints(kDepthDisplay),
    OfPoints("rviz/Temperature"),
    OfPoints("rviz/Illuminance"),
    OfPoints("rviz/FluidPressure"),
    OfPoints("rviz/RelativeHumidity"),
    {"rviz/Range", "Color"},
    {"rviz/WrenchStamped", "Force Color"},
    {"rviz/TwistStamped", "Linear Color"},
    {"rviz/AccelStamped", "Linear Color"},
    {kEffortDisplay}};

// Displays of two vectors, and what they call them.
struct ArrowProperties {
  const char* kind;
  const char* linear_scale;
  const char* angular_scale;
  const char* angular_color;
};
constexpr ArrowProperties kArrowDisplays[] = {
    {"rviz/WrenchStamped", "Force Arrow Scale", "Torque Arrow Scale", "Torque Color"},
    {"rviz/TwistStamped", "Linear Arrow Scale", "Angular Arrow Scale", "Angular Color"},
    {"rviz/AccelStamped", "Linear Arrow Scale", "Angular Arrow Scale", "Angular Color"}};

constexpr const char* kKeepingDisplay = "rviz/Odometry";
constexpr const char* kHistories[] = {"History Length", "Buffer Length"};  // of other displays

const ShownProperties* Find(const std::string& kind) {
  const auto* const found =
      std::find_if(std::begin(kTopicDisplays), std::end(kTopicDisplays),
                   [&](const ShownProperties& each) { return each.kind == kind; });
  return found == std::end(kTopicDisplays) ? nullptr : found;
}

class StyleReader {
 public:
  StyleReader(const YAML::Node& display, const std::string& kind)
      : display_(display), kind_(kind), has_(*Find(kind)) {
    const YAML::Node below = Member(display, "Shape");
    properties_ = below.IsDefined() && below.IsMap() ? below
                  : kind == kKeepingDisplay          ? YAML::Node(YAML::NodeType::Undefined)
                                                     : display;
  }

  TopicStyle Read() {
    if (kind_ == kEffortDisplay) {
      AddEffort();
    } else {
      AddLook();
    }
    if (!style_.text.empty()) style_.text = "(" + style_.text + ")";
    return std::move(style_);
  }

 private:
  void Add(const std::string& item) { style_.text += (style_.text.empty() ? "" : ",") + item; }
  void Remark(const std::string& what) { style_.remarks.push_back(what); }

  void AddLook() {
    if (kind_ == kDepthDisplay) AddDepths();
    AddColor();
    if (HasAlpha() && Member(properties_, "Alpha").IsDefined()) {
      const double alpha = NumberOf(properties_, "Alpha", 1, 0, 1);
      const bool is_usually_clear = kind_ == "rviz/Map" || kind_ == "rviz/Range";
      if (alpha < 1 || is_usually_clear) Add("alpha=" + options::NumberText(alpha));
    }
    AddShapeAndSize();
    if (kind_ == "rviz/Map") AddMap();
    for (const ArrowProperties& arrows : kArrowDisplays) {
      if (kind_ == arrows.kind) AddArrows(arrows);
    }
    AddCovariance();
    AddEarlier();
  }

  // Lines of one pixel.
  bool HasThinLines() const {
    if (kind_ == "rviz/Path") return TextOf(display_, "Line Style", "Lines") == "Lines";
    if (kind_ != "rviz/PoseArray") return kind_ == "rviz/Polygon";
    return TextOf(display_, "Shape", "Arrow (Flat)") == "Arrow (Flat)";
  }

  // RViz does not use that of lines.
  bool HasAlpha() const { return kind_ != "rviz/Path" && !HasThinLines(); }

  // As `property` has it, but within what is drawn, which is said.
  double Limited(const YAML::Node& node, const char* property, double usual, double least,
                 double most) {
    const Limit limit = LimitOf(node, property, usual, least, most);
    if (!limit.remark.empty()) Remark(limit.remark);
    return limit.value;
  }

  // RViz does not use its Alpha.
  void AddEffort() {
    const auto number = [&](const char* property, double usual) {
      return options::NumberText(Limited(display_, property, usual, kSmallestShown, kLargestShown));
    };
    Add("size=" + number("Scale", 1));
    Add("width=" + number("Width", 0.02));
    if (NumberOf(display_, "History Length", 1, 1, 1e5) > 1) {
      Remark("History Length: the newest efforts alone are drawn");
    }
    const YAML::Node joints = Member(display_, "Joints");
    if (!joints.IsDefined() || !joints.IsMap()) return;
    std::string names;
    for (const auto& each : joints) {
      if (!each.first.IsScalar() || !each.second.IsMap()) continue;
      if (BoolOf(each.second, "Value", true)) continue;
      const std::string name = each.first.as<std::string>();
      if (!AddHidden(name, names)) Remark("the ring of the joint '" + name + "' is not left out");
    }
    if (!names.empty()) Add("without=" + names);
  }

  // Of an image of depths.
  void AddDepths() {
    Add("cloud=on");
    const std::string colors = TextOf(display_, "Color Image Topic", "");
    if (IsTopicName(colors)) {
      Add("colors=" + colors);
      has_color_image_ = true;
    } else if (!colors.empty()) {
      Remark("Color Image Topic '" + colors + "' is no name of a topic");
    }
    const std::string transport = TextOf(display_, "Color Transport Hint", "raw");
    if (has_color_image_ && transport != "raw") {
      Remark("Color Transport Hint '" + transport + "' is read as 'raw'");
    }
    const YAML::Node automatic = Member(display_, "Auto Size");
    const bool is_map = automatic.IsDefined() && automatic.IsMap();
    has_own_size_ = is_map ? BoolOf(automatic, "Value", true) : BoolOf(display_, "Auto Size", true);
    if (is_map && has_own_size_ && NumberOf(automatic, "Auto Size Factor", 1, 0, 1e3) != 1) {
      Remark("Auto Size Factor is not taken: points are as large as their pixels");
    }
    const YAML::Node occlusion = Member(display_, "Occlusion Compensation");
    if (occlusion.IsDefined() && occlusion.IsMap() && BoolOf(occlusion, "Value", false)) {
      Remark("Occlusion Compensation: what is behind something nearer is not kept");
    }
  }

  void AddColor() {
    if (has_color_image_) return;  // RViz takes no other transformer then
    if (has_.color == nullptr) return AddTransformer();
    AddColor("color=", has_.color);
  }

  // Without one, or with a text that is none, it is that of RViz, which is ours, too.
  void AddColor(const char* key, const char* property) {
    if (const auto color = FindColor(properties_, property)) Add(key + ToHex(*color));
  }

  // Of points.
  void AddTransformer() {
    const std::string transformer = TextOf(display_, "Color Transformer", "");
    if (transformer == "FlatColor") {
      Add("color=" + ToHex(ColorOf(display_, "Color", {1, 1, 1})));
    } else if (transformer == "AxisColor") {
      AddAxisScale();
    } else if (transformer == "Intensity") {
      AddIntensityScale();
    } else if (!transformer.empty() && transformer != "RGB8" && transformer != "RGBF32") {
      Remark("Color Transformer '" + transformer +
             "' is not taken; its points have the colours of the message, or are white");
    }
  }

  void AddAxisScale() {
    const std::string axis = TextOf(display_, "Axis", "Z");
    Add(std::string("by=") + (axis == "X" ? "x" : axis == "Y" ? "y" : "z"));
    const YAML::Node bounds = Member(display_, "Autocompute Value Bounds");
    const bool is_map = bounds.IsDefined() && bounds.IsMap();
    const bool are_of_points =
        is_map ? BoolOf(bounds, "Value", true) : BoolOf(display_, "Autocompute Value Bounds", true);
    if (!are_of_points) AddBounds(is_map ? bounds : display_, "Min Value", -10, "Max Value", 10);
    if (!BoolOf(display_, "Use Fixed Frame", true)) Add("axis=message");
  }

  void AddIntensityScale() {
    const std::string channel = TextOf(display_, "Channel Name", "intensity");
    if (!IsFieldName(channel)) {
      Remark("Channel Name '" + channel + "' cannot be taken; its points are white");
    }
    Add("by=" + (IsFieldName(channel) ? channel : "_"));
    if (channel == "x" || channel == "y" || channel == "z") Add("axis=message");
    if (!BoolOf(display_, "Autocompute Intensity Bounds", true)) {
      AddBounds(display_, "Min Intensity", 0, "Max Intensity", 4096);
    }
    if (!BoolOf(display_, "Use rainbow", true)) {
      Add("low=" + ToHex(ColorOf(display_, "Min Color", {0, 0, 0})));
      Add("high=" + ToHex(ColorOf(display_, "Max Color", {1, 1, 1})));
    } else if (BoolOf(display_, "Invert Rainbow", false)) {
      Add("rainbow=inverted");
    }
  }

  void AddBounds(const YAML::Node& node, const char* from, double usual_from, const char* to,
                 double usual_to) {
    const auto bound = [&](const char* property, double usual) {
      return options::NumberText(NumberOf(node, property, usual, -kLargestBound, kLargestBound));
    };
    Add("from=" + bound(from, usual_from));
    Add("to=" + bound(to, usual_to));
  }

  void AddShapeAndSize() {
    const std::string shape = has_.has_shape ? TextOf(display_, "Shape", "") : "";
    double size = 0;
    const bool are_many = kind_ == "rviz/PoseArray";
    if (shape == "Axes") {
      Add("shape=axes");
      size = Metres(properties_, "Axes Length", 0);
      AddMetres("width=", properties_, "Axes Radius", are_many ? 0.01 : 0.1);
    } else if (shape == "Arrow (3D)") {
      Add("shape=arrows");
      size = AddArrowParts(properties_, {0.23, 0.01, 0.07, 0.03}, "Shaft Radius", "Head Radius");
    } else if (!are_many && has_.has_shape) {
      size = AddArrowParts(properties_, {1, 0.05, 0.3, 0.1}, "Shaft Radius", "Head Radius");
    } else if (has_.only_if == nullptr ||
               TextOf(display_, has_.only_if, has_.usually) != std::string(has_.not_if)) {
      for (const char* const part : has_.sizes) {
        if (part != nullptr) size += Metres(properties_, part, 0);
      }
    }
    if (HasThinLines()) Add("pixels=1");
    AddPathPoses();
    if (has_.color == nullptr) {
      const std::string style = TextOf(display_, "Style", "");
      if (style == "Points") {
        Add("pixels=" + options::NumberText(NumberOf(display_, "Size (Pixels)", 3, kSmallestPixels,
                                                     kLargestPixels)));
      }
      if (style == "Spheres") Add("shape=spheres");
      if (style == "Boxes") Add("shape=cubes");
    }
    if (size > kLargestShown) {
      Remark("an arrow of " + options::NumberText(size) + " m is drawn with " +
             options::NumberText(kLargestShown) + " m");
    }
    if (size > 0 && !has_own_size_) {
      Add("size=" + options::NumberText(std::clamp(size, kSmallestShown, kLargestShown)));
    }
  }

  double Metres(const YAML::Node& node, const char* property, double usual) {
    return Limited(node, property, usual, 0, kLargestShown);
  }

  void AddMetres(const char* key, const YAML::Node& node, const char* property, double usual) {
    Add(key + options::NumberText(Limited(node, property, usual, kSmallestShown, kLargestShown)));
  }

  // RViz's, m.
  struct Arrow {
    double shaft, shaft_width, head, head_width;
  };
  // The length of the whole; 0: the file has nothing of it.
  double AddArrowParts(const YAML::Node& node, const Arrow& usual, const char* shaft_width,
                       const char* head_width) {
    const auto has = [&](const char* property) { return Member(node, property).IsDefined(); };
    if (!has("Shaft Length") && !has("Head Length") && !has(shaft_width) && !has(head_width)) {
      return 0;
    }
    AddMetres("shaft_width=", node, shaft_width, usual.shaft_width);
    AddMetres("head_width=", node, head_width, usual.head_width);
    const double head = Metres(node, "Head Length", usual.head);
    Add("head=" + options::NumberText(std::max(head, kSmallestShown)));
    return Metres(node, "Shaft Length", usual.shaft) + head;
  }

  // Of a path.
  void AddPathPoses() {
    const std::string poses = TextOf(display_, "Pose Style", "None");
    double length = 0;
    if (poses == "Axes") {
      Add("shape=axes");
      length = Metres(display_, "Length", 0.3);
      AddMetres("pose_width=", display_, "Radius", 0.03);  // RViz's is a diameter
    } else if (poses == "Arrows") {
      Add("shape=arrows");
      length = AddArrowParts(display_, {0.1, 0.1, 0.2, 0.3}, "Shaft Diameter", "Head Diameter");
      if (length == 0) length = 0.3;
      AddColor("pose_color=", "Pose Color");
    } else if (poses != "None") {
      Remark("Pose Style '" + poses + "': poses along the line are not drawn");
    }
    if (length > 0) {
      Add("pose_size=" + options::NumberText(std::clamp(length, kSmallestShown, kLargestShown)));
    }
  }

  void AddArrows(const ArrowProperties& has) {
    // The file has the scale of a shaft; its head is 0.3 of it.
    constexpr double kWholeArrow = 1.3;
    const auto number = [&](const char* property, double usual, double least, double most) {
      return NumberOf(display_, property, usual, least, most);
    };
    const double force = number(has.linear_scale, 2, 0, kLongestArrow / kWholeArrow);
    const double torque = number(has.angular_scale, 2, 0, kLongestArrow / kWholeArrow);
    Add("force=" + options::NumberText(kWholeArrow * force));
    Add("torque=" + options::NumberText(kWholeArrow * torque));
    Add("width=" + options::NumberText(number("Arrow Width", 0.5, kSmallestShown, kLargestShown)));
    Add("torque_color=" + ToHex(ColorOf(display_, has.angular_color, {0.8, 0.8, 0.2})));
    if (!BoolOf(display_, "Hide Small Values", true)) Add("small=shown");
  }

  void AddCovariance() {
    if (kind_ != "rviz/PoseWithCovariance" && kind_ != kKeepingDisplay) return;
    const YAML::Node covariance = Member(display_, "Covariance");
    if (!BoolOf(covariance, "Value", true)) return;
    const auto add_number = [&](const std::string& key, const YAML::Node& node,
                                const char* property, double usual, double most) {
      Add(key + "=" + options::NumberText(NumberOf(node, property, usual, 0, most)));
    };
    const YAML::Node position = Member(covariance, "Position");
    if (BoolOf(position, "Value", true)) {
      add_number("covariance", position, "Scale", 1, kLargestCovarianceScale);
      add_number("covariance_alpha", position, "Alpha", 0.3, 1);
      Add("covariance_color=" + ToHex(ColorOf(position, "Color", {0.8, 0.2, 0.8})));
    }
    const YAML::Node turn = Member(covariance, "Orientation");
    if (!BoolOf(turn, "Value", true)) return;
    add_number("turn_covariance", turn, "Scale", 1, kLargestCovarianceScale);
    add_number("turn_covariance_alpha", turn, "Alpha", 0.5, 1);
    const double offset = NumberOf(turn, "Offset", 1, kSmallestShown, kLargestShown);
    Add("turn_covariance_offset=" + options::NumberText(offset));
    if (TextOf(turn, "Color Style", "Unique") == "RGB") {
      Add("turn_covariance_color=axes");
    } else {
      Add("turn_covariance_color=" + ToHex(ColorOf(turn, "Color", {1, 1, 127.0 / 255})));
    }
    if (TextOf(turn, "Frame", "Local") == "Fixed") {
      Remark(
          "the covariance of the orientation is drawn about the axes of the pose, not fixed ones");
    }
  }

  void AddMap() {
    const std::string scheme = TextOf(display_, "Color Scheme", "map");
    if (scheme == "costmap" || scheme == "raw") {
      Add("scheme=" + scheme);
    } else if (scheme != "map") {
      Remark("Color Scheme '" + scheme + "' is drawn as 'map'");
    }
    Add("updates=on");
    if (BoolOf(display_, "Draw Behind", false)) {
      Add("behind=on");
      Remark("Draw Behind: it is drawn behind other maps, but in front of what is below it");
    }
  }

  void AddEarlier() {
    const auto number = [&](const char* property, double usual, double most) {
      return Limited(display_, property, usual, 0, most);
    };
    constexpr auto kMostKept = static_cast<double>(kMostKeptMessages);
    if (kind_ == kKeepingDisplay) {
      const double kept = number("Keep", 100, kMostKept);  // 0: all
      Add("keep=" + options::NumberText(kept < 1 ? kMostKept : std::floor(kept)));
      Add("step=" + options::NumberText(number("Position Tolerance", 0.1, kLargestStep)));
      Add("turn=" + options::NumberText(number("Angle Tolerance", 0.1, kLargestStep)));
      return;
    }
    for (const char* const property : kHistories) {
      const double kept = std::floor(number(property, 1, kMostKept));
      if (kept > 1) Add("keep=" + options::NumberText(kept));
    }
    const double decay = number("Decay Time", 0, kLongestDecay);
    if (decay > 0) Add("decay=" + options::NumberText(decay));
  }

  const YAML::Node display_;
  YAML::Node properties_;
  const std::string kind_;
  const ShownProperties& has_;
  bool has_color_image_ = false, has_own_size_ = false;  // of depths
  TopicStyle style_;
};

}  // namespace

bool IsTopicDisplay(const std::string& kind) { return Find(kind) != nullptr; }

TopicStyle StyleOf(const YAML::Node& display, const std::string& kind) {
  return StyleReader(display, kind).Read();
}

}  // namespace kinescope::app::rviz
