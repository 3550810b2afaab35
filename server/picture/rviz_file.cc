#include "server/picture/rviz_file.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string_view>
#include <utility>

#include "core/graph_view.h"
#include "core/suit_colors.h"
#include "core/system/errors.h"
#include "core/system/input_file.h"
#include "core/system/starts_with.h"
#include "render/scene_look.h"
#include "server/options/ros_names.h"
#include "server/options/text.h"
#include "server/options/yaml_file.h"
#include "server/picture/rviz_frames.h"
#include "server/picture/rviz_topics.h"
#include "server/picture/rviz_values.h"
#include "server/picture/rviz_view.h"

namespace kinescope::app {
namespace {

using rviz::BoolOf;
using rviz::LineOf;
using rviz::Member;
using rviz::Quoted;
using rviz::Shown;
using rviz::TextOf;

constexpr int kDeepest = 100;  // levels; RViz writes trees of frames
constexpr std::size_t kMostRemarks = 200;
constexpr double kDarkest = 48.0 / 255;  // RViz's own background
constexpr double kNearest = 0.05;        // m, a clip distance that cuts nothing off
// A namespace of our markers (server/ros/markers.h), and the part of the scene that they show.
struct MarkerPart {
  const char* ns;
  const char* part;
};
constexpr MarkerPart kMarkerParts[] = {{"loads", "loads"},
                                       {"com", "com"},
                                       {"cop", "cop"},
                                       {"support", "support"},
                                       {"foot_forces", "forces"},
                                       {"hand_loads", "hand_loads"}};

class RvizReader {
 public:
  RvizReader(std::string path, int height_px) : path_(std::move(path)), height_px_(height_px) {}

  RvizPicture Read(const YAML::Node& root) {
    const YAML::Node manager = Member(root, "Visualization Manager");
    if (!manager.IsDefined() || !manager.IsMap()) {
      throw UsageError(path_ + " is no configuration of RViz: it has no 'Visualization Manager'");
    }
    NameOtherThanMaps(manager, {"Global Options", "Views"});
    ReadGlobalOptions(manager);
    ReadTools(Member(manager, "Tools"));
    ReadDisplays(Member(manager, "Displays"), BoolOf(manager, "Enabled", true));
    NameRingsWithoutRobots();
    SetParts(manager);
    ReadView(manager, /*is_whole=*/Member(root, "Window Geometry").IsDefined());
    ReadTime(Member(root, "Panels"));
    return std::move(picture_);
  }

 private:
  void Set(const char* option, std::string text, int line) {
    picture_.settings.push_back({option, std::move(text), line});
  }

  void Remark(const YAML::Node& node, const std::string& what) {
    if (picture_.remarks.size() < kMostRemarks) {
      picture_.remarks.push_back(fmt::format("{}:{}: {}", path_, LineOf(node), Shown(what)));
    } else if (picture_.remarks.size() == kMostRemarks) {
      picture_.remarks.push_back(path_ + ": and more that is not drawn");
    }
  }

  // A class of RViz 2 says so in its name.
  void RefuseOther(const YAML::Node& node, const std::string& kind) {
    if (!StartsWith(kind, "rviz_common/") && !StartsWith(kind, "rviz_default_plugins/")) return;
    throw UsageError(fmt::format("{}:{}: is a configuration of RViz 2 ({}); save one with RViz 1",
                                 path_, LineOf(node), Quoted(kind)));
  }

  void ReadGlobalOptions(const YAML::Node& manager) {
    const YAML::Node all = Member(manager, "Global Options");
    const YAML::Node background = Member(all, "Background Color");
    const int line = LineOf(background.IsDefined() ? background : manager);
    const Rgb rgb = rviz::ColorOf(all, "Background Color", {kDarkest, kDarkest, kDarkest});
    NameBadColors(all, "");
    Set("background", ToHex(rgb), line);
    Set("theme", render::ThemeOn(rgb) == render::Theme::kDark ? "dark" : "light", line);
    picture_.fixed_frame = rviz::FrameOf(all, "Fixed Frame", kUsualFrameOfRviz);
    picture_.fixed_frame_line = LineOf(all.IsDefined() ? all : manager);
    if (!BoolOf(all, "Default Light", true)) {
      Remark(all, "Default Light is off; bodies are lit all the same");
    }
  }

  void NameOtherThanMaps(const YAML::Node& map, std::initializer_list<const char*> names) {
    for (const char* const name : names) {
      const YAML::Node member = Member(map, name);
      const bool is_one = !member.IsDefined() || member.IsNull() || member.IsMap();
      if (!is_one) Remark(member, fmt::format("{} is no map: nothing of it is taken", name));
    }
  }

  void ReadDisplays(const YAML::Node& displays, bool is_on) {
    if (!displays.IsDefined() || displays.IsNull()) return;
    if (!displays.IsSequence()) return Remark(displays, "Displays is no list: none is drawn");
    for (const YAML::Node& display : displays) {
      if (!display.IsMap()) {
        Remark(display, "an entry of Displays that is no map is left out");
        continue;
      }
      const std::string kind = TextOf(display, "Class", "");
      RefuseOther(display, kind);
      if (is_on && kind.empty()) {
        Remark(display, fmt::format("a display without a Class {} is not drawn",
                                    Quoted(TextOf(display, "Name", ""))));
      }
      const bool is_shown =
          is_on && !kind.empty() && BoolOf(display, "Enabled", BoolOf(display, "Value", false));
      if (kind == "rviz/Group") {
        ReadDisplays(Member(display, "Displays"), is_shown);
      } else if (is_shown) {
        ReadDisplay(display, kind);
      }
    }
  }

  // `called`: whose colours they are.
  void NameBadColors(const YAML::Node& map, const std::string& called) {
    if (!map.IsDefined() || !map.IsMap()) return;
    for (const auto& each : map) {
      if (!each.first.IsScalar()) continue;
      const std::string name = each.first.Scalar();
      if (each.second.IsMap()) NameBadColors(each.second, called);
      const bool is_color = name == "Color" || EndsWith(name, " Color");
      if (!is_color || each.second.IsMap()) continue;
      const bool is_text = each.second.IsScalar();
      if (is_text && rviz::IsColor(each.second.Scalar())) continue;
      Remark(each.second, (called.empty() ? "" : called + ": ") + name + " " +
                              (is_text ? Quoted(each.second.Scalar()) : "that is no text") +
                              " is no r; g; b, #rrggbb or name of a colour; RViz's own is taken");
    }
  }

  void ReadDisplay(const YAML::Node& display, const std::string& kind) {
    const std::string called = fmt::format("{} {}", kind, Quoted(TextOf(display, "Name", "")));
    NameBadColors(display, called);
    if (rviz::IsFrameDisplay(kind)) {
      ReadFrameDisplay(display, kind, called);
    } else if (kind == "rviz/RobotModel") {
      ReadRobotModel(display, called);
    } else if (kind == "rviz/Marker" || kind == "rviz/MarkerArray") {
      const bool is_ours = IsOurs(display);
      if (is_ours) ReadParts(display);
      has_markers_ = true;
      ReadTopic(display, called, "Marker Topic", MarkerStyleOf(display, kind, called, is_ours),
                is_ours);
    } else if (kind == "rviz/Image" || kind == "rviz/Camera") {
      ReadTopic(display, called, "Image Topic",
                kind == "rviz/Camera" ? CameraStyleOf(display, called) : "");
      if (!BoolOf(display, "Normalize Range", true)) {
        Remark(display, called +
                            ": Normalize Range is off: a picture of numbers is drawn between "
                            "its smallest and its largest value all the same");
      }
    } else if (kind == "rviz/InteractiveMarkers") {
      ReadTopic(display, called, "Update Topic", InteractiveStyleOf(display));
    } else if (kind == "rviz/DepthCloud") {
      ReadTopic(display, called, "Depth Map Topic", StyleOf(display, kind, called));
    } else if (rviz::IsTopicDisplay(kind)) {
      if (kind == "rviz/Effort") rings_.emplace_back(display, called);
      ReadTopic(display, called, "Topic", StyleOf(display, kind, called));
    } else {
      Remark(display, called + " is not drawn");
    }
  }

  // Without topics, the floor of the scene takes the place of a level grid.
  void ReadFrameDisplay(const YAML::Node& display, const std::string& kind,
                        const std::string& called) {
    std::vector<std::string> remarks;
    const auto read = rviz::FrameDisplayOf(display, kind, picture_.fixed_frame, remarks);
    for (const std::string& remark : remarks) Remark(display, called + ": " + remark);
    if (!read) return Remark(display, called + " is not drawn: " + read.error());
    picture_.topics.push_back({read->name, read->style, Shown(called), false, LineOf(display),
                               read->is_every_frame, read->is_floor, read->floor_differs});
    has_floor_ = has_floor_ || read->is_floor;
    has_frames_ = has_frames_ || read->has_axes;
  }

  void NameOffsetOfPath(const YAML::Node& display, const std::string& called) {
    const YAML::Node offset = Member(display, "Offset");
    if (!offset.IsDefined() || !offset.IsMap()) return;
    for (const char* const axis : {"X", "Y", "Z"}) {
      if (rviz::NumberOf(offset, axis, 0, -rviz::kFarthestCamera, rviz::kFarthestCamera) == 0)
        continue;
      return Remark(display, called + ": Offset is not taken: the path is where it is");
    }
  }

  // A robot is drawn as a whole.
  void NameLinks(const YAML::Node& display, const std::string& called) {
    const YAML::Node links = Member(display, "Links");
    if (!links.IsDefined() || !links.IsMap()) return;
    std::vector<std::string> off, others;
    for (const auto& link : links) {
      if (!link.first.IsScalar() || !link.second.IsMap()) continue;
      const std::string name = link.first.as<std::string>();
      if (!BoolOf(link.second, "Value", true)) off.push_back(name);
      if (BoolOf(link.second, "Show Axes", false) || BoolOf(link.second, "Show Trail", false) ||
          rviz::NumberOf(link.second, "Alpha", 1, 0, 1) < 1) {
        others.push_back(name);
      }
    }
    const auto remark = [&](const std::vector<std::string>& names, const char* what) {
      if (names.empty()) return;
      Remark(display,
             fmt::format("{}: {}: {}{}", called, what, names.front(),
                         names.size() > 1 ? fmt::format(" and {} others", names.size() - 1) : ""));
    };
    remark(off, "links that are off are drawn");
    remark(others, "axes, trails and Alpha of single links are not drawn");
  }

  // Of efforts.
  void NameRingsWithoutRobots() {
    for (const auto& [display, called] : rings_) {
      const std::string name = TextOf(display, "Robot Description", "robot_description");
      const bool is_shown = std::any_of(
          picture_.robots.begin(), picture_.robots.end(), [&](const RvizPicture::Robot& robot) {
            return robot.option.substr(0, robot.option.find_first_of("@(")) == "ros:" + name;
          });
      if (is_shown) continue;
      Remark(display, called +
                          ": rings are drawn about joints of robots that are shown, and no "
                          "RobotModel that is on has " +
                          Quoted(name));
    }
  }

  void ReadRobotModel(const YAML::Node& display, const std::string& called) {
    if (!BoolOf(display, "Visual Enabled", true)) {
      Remark(display, called + ": collision geometry is not drawn");
      return;
    }
    if (BoolOf(display, "Collision Enabled", false)) {
      Remark(display, called + ": Collision Enabled: collision geometry is not drawn");
    }
    NameLinks(display, called);
    const std::string name = TextOf(display, "Robot Description", "robot_description"),
                      prefix = TextOf(display, "TF Prefix", "");
    const double alpha = rviz::NumberOf(display, "Alpha", 1, 0, 1);
    if (IsTopicName(name) && (prefix.empty() || IsFrameName(prefix))) {
      const std::string style = alpha < 1 ? "(alpha=" + options::NumberText(alpha) + ")" : "";
      picture_.robots.push_back({"ros:" + name + (prefix.empty() ? "" : "@tf:" + prefix) + style,
                                 Shown(called), LineOf(display)});
    } else {
      Remark(display, fmt::format("{} is not drawn: {} with the prefix {} is no name in ROS",
                                  called, Quoted(name), Quoted(prefix)));
    }
    // Of the first one: that is the people's, where there is no graph that says more.
    if (!has_model_ && alpha < 1) {
      Set("body_opacity", options::NumberText(alpha), LineOf(display));
    }
    if (alpha == 0) Remark(display, called + ": " + rviz::NotSeen(display));
    has_model_ = true;
  }

  // What the display has otherwise is named.
  std::string StyleOf(const YAML::Node& display, const std::string& kind,
                      const std::string& called) {
    rviz::TopicStyle style = rviz::StyleOf(display, kind);
    if (kind == "rviz/Path") NameOffsetOfPath(display, called);
    for (const std::string& remark : style.remarks) Remark(display, called + ": " + remark);
    return std::move(style.text);
  }

  void ReadTopic(const YAML::Node& display, const std::string& called, const char* member,
                 const std::string& style, bool is_of_people = false) {
    const bool is_marker = std::string_view(member) == "Marker Topic";
    const bool is_array = TextOf(display, "Class", "") == "rviz/MarkerArray";
    std::string name = TextOf(display, member,
                              !is_marker ? ""
                              : is_array ? "visualization_marker_array"
                                         : "visualization_marker");
    const bool is_depth = std::string_view(member) == "Depth Map Topic";
    const char* const hint = is_depth ? "Depth Map Transport Hint" : "Transport Hint";
    const std::string transport = TextOf(display, hint, "raw");
    if (transport == "compressed" && !is_depth && !name.empty()) {
      name += "/compressed";
    } else if (transport != "raw") {
      Remark(display, fmt::format("{}: {} {} is read as 'raw'", called, hint, Quoted(transport)));
    }
    if (IsTopicName(name)) {
      picture_.topics.push_back({name, style, Shown(called), is_of_people, LineOf(display)});
    } else {
      const std::string why =
          name.empty() ? "it has no topic" : Quoted(name) + " is no name of a topic";
      Remark(display, called + " is not drawn: " + why);
    }
  }

  // RViz lays the scene over the image, and the image over both: the share of the scene is what the
  // latter leaves.
  std::string CameraStyleOf(const YAML::Node& display, const std::string& called) {
    const std::string rendering = TextOf(display, "Image Rendering", "background and overlay");
    const bool has_overlay = rendering != "background";
    if (rendering == "overlay") {
      Remark(display, called + ": Image Rendering 'overlay' is drawn as 'background and overlay'");
    }
    if (rviz::NumberOf(display, "Zoom Factor", 1, 0, 1e5) != 1) {
      Remark(display, called + ": Zoom Factor is not taken: the whole image is shown");
    }
    NameInvisible(Member(display, "Visibility"), display, called);
    const double overlay = rviz::NumberOf(display, "Overlay Alpha", 0.5, 0, 1);
    return "(scene=" + options::NumberText(has_overlay ? 1 - overlay : 1) + ")";
  }

  // What a Camera does not show although others do. Groups have members of their own.
  void NameInvisible(const YAML::Node& visibility, const YAML::Node& display,
                     const std::string& called) {
    if (!visibility.IsDefined() || !visibility.IsMap()) return;
    for (const auto& each : visibility) {
      if (!each.first.IsScalar()) continue;
      const std::string name = each.first.as<std::string>();
      const bool is_group = each.second.IsMap();
      const bool is_on = is_group ? BoolOf(each.second, "Value", true)
                                  : name == "Value" || BoolOf(visibility, name, true);
      if (is_on) continue;
      return Remark(display, called + ": Visibility is not taken: " + Quoted(name) +
                                 " and all else of the scene is drawn over its picture");
    }
  }

  // The first tool is the active one: only Interact shows what it takes.
  void ReadTools(const YAML::Node& tools) {
    if (!tools.IsDefined() || !tools.IsSequence() || tools.size() == 0) return;
    has_handles_ = TextOf(tools[0], "Class", "") == "rviz/Interact";
  }

  std::string InteractiveStyleOf(const YAML::Node& display) const {
    std::vector<std::string> items;
    if (!BoolOf(display, "Show Descriptions", true)) items.emplace_back("names=off");
    if (BoolOf(display, "Show Axes", false)) items.emplace_back("shape=axes");
    if (!BoolOf(display, "Enable Transparency", true)) items.emplace_back("alpha=1");
    if (!has_handles_) items.emplace_back("handles=off");
    return items.empty() ? "" : fmt::format("({})", fmt::join(items, ","));
  }

  // As RViz does, a display of single markers hears those of "<topic>_array", too.
  std::string MarkerStyleOf(const YAML::Node& display, const std::string& kind,
                            const std::string& called, bool is_ours) {
    const std::string hidden = HiddenNamespaces(display, called, is_ours);
    std::string items = kind == "rviz/Marker" ? "array=on" : "";
    if (!hidden.empty()) items += (items.empty() ? "without=" : ",without=") + hidden;
    return items.empty() ? items : "(" + items + ")";
  }

  // "a|b": those of other nodes; ours are parts of the scene.
  std::string HiddenNamespaces(const YAML::Node& display, const std::string& called, bool is_ours) {
    const YAML::Node namespaces = Member(display, "Namespaces");
    std::string names;
    if (!namespaces.IsDefined() || !namespaces.IsMap()) return names;
    for (const auto& each : namespaces) {
      if (!each.first.IsScalar()) continue;
      const std::string name = each.first.as<std::string>();
      const bool is_part = std::any_of(std::begin(kMarkerParts), std::end(kMarkerParts),
                                       [&](const MarkerPart& each) { return name == each.ns; });
      if ((is_ours && is_part) || BoolOf(namespaces, name, true)) continue;
      if (!rviz::AddHidden(name, names)) {
        Remark(display, called + ": the namespace " + Quoted(name) + " is not left out");
      }
    }
    return names;
  }

  // Of our markers: the topic is one as the bridge has it, and the display has met no namespaces,
  // or one of ours.
  static bool IsOurs(const YAML::Node& display) {
    if (!EndsWith("/" + TextOf(display, "Marker Topic", ""), "/markers")) return false;
    const YAML::Node namespaces = Member(display, "Namespaces");
    if (!namespaces.IsDefined() || !namespaces.IsMap() || namespaces.size() == 0) return true;
    return std::any_of(
        std::begin(kMarkerParts), std::end(kMarkerParts),
        [&](const MarkerPart& each) { return Member(namespaces, each.ns).IsDefined(); });
  }

  // Parts are drawn that some display of our markers shows.
  void ReadParts(const YAML::Node& display) {
    const YAML::Node namespaces = Member(display, "Namespaces");
    for (const auto& [ns, part] : kMarkerParts) {
      if (BoolOf(namespaces, ns, true)) shown_parts_.insert(part);
    }
  }

  void SetParts(const YAML::Node& manager) {
    const int line = LineOf(manager);
    Set("floor", has_floor_ ? "on" : "off", line);
    Set("figure", "urdf", line);
    std::string hidden = "shadows";  // RViz has none
    if (!has_model_) hidden += ",body";
    if (!has_markers_ && picture_.topics.empty()) hidden += ",markers";  // the way of all topics
    for (const auto& [ns, part] : kMarkerParts) {
      if (shown_parts_.count(part) == 0) hidden += std::string(",") + part;
    }
    Set("hide", hidden, line);
    const bool has_topics = std::any_of(
        picture_.topics.begin(), picture_.topics.end(),
        [](const RvizPicture::Topic& topic) { return !StartsWith(topic.name, kGridInFrame); });
    if (!has_model_ && shown_parts_.empty() && !has_topics) {
      Remark(manager, "no display that is on shows people: of them nothing is drawn");
    }
    if (has_frames_) Set("show", "link_frames", line);  // of a source without TF
  }

  // `is_whole`: RViz writes more after it.
  void ReadView(const YAML::Node& manager, bool is_whole) {
    const YAML::Node current = Member(Member(manager, "Views"), "Current");
    const YAML::Node& place = current.IsDefined() ? current : manager;
    RefuseOther(place, TextOf(current, "Class", ""));
    const rviz::View view = rviz::ViewOf(current, height_px_);
    if (!view.why_not_as_saved.empty()) {
      const bool is_cut = !is_whole && TextOf(current, "Class", "").empty();
      Remark(place,
             view.why_not_as_saved +
                 (is_cut ? "; the file may be cut off: RViz ends it with Window Geometry" : ""));
    }
    if (rviz::NumberOf(current, "Near Clip Distance", 0.01, 0, rviz::kFarthestCamera) > kNearest) {
      Remark(place, "Near Clip Distance is not taken: what is nearer is drawn, too");
    }
    const std::string target = rviz::FrameOf(current, "Target Frame", "<Fixed Frame>");
    const std::string kind = TextOf(current, "Class", "");
    picture_.target.line = LineOf(place);
    // RViz has nothing of a view that it cannot load.
    const bool is_loaded = view.why_not_as_saved.empty();
    if (is_loaded && target != "<Fixed Frame>" && target != picture_.fixed_frame) {
      picture_.target.frame = target;
    }
    if (kind == "rviz/ThirdPersonFollower") picture_.target.turn = ":heading";
    if (kind == "rviz/FrameAligned") picture_.target.turn = ":pose";
    const auto camera = rviz::CameraOptionsOf(view.camera);
    if (!camera) {
      Remark(place, fmt::format("the camera is more than {} m away; ours stays where it is",
                                rviz::kFarthestCamera));
      return;
    }
    Set("camera", camera->place, LineOf(place));
    Set("fov", camera->fov, LineOf(place));
    Set("projection", camera->projection, LineOf(place));
  }

  void ReadTime(const YAML::Node& panels) {
    if (!panels.IsDefined() || !panels.IsSequence()) return;
    for (const YAML::Node& panel : panels) {
      if (TextOf(panel, "Class", "") != "rviz/Time") continue;
      if (TextOf(panel, "SyncMode", "0") == "0") continue;
      Remark(panel, "the Time panel's SyncMode is not taken: all are of the time of the picture");
    }
  }

  const std::string path_;
  const int height_px_;
  RvizPicture picture_;
  bool has_handles_ = true;  // of interactive markers
  bool has_floor_ = false, has_model_ = false, has_markers_ = false, has_frames_ = false;
  std::set<std::string> shown_parts_;
  // Displays, and what they are called.
  std::vector<std::pair<YAML::Node, std::string>> rings_;
};

template <class Load>
RvizPicture Read(const std::string& path, int height_px, const Load& load) {
  try {
    return RvizReader(path, height_px).Read(load());
  } catch (const YAML::BadFile&) {
    throw UsageError(CannotRead(path));
  } catch (const YAML::Exception& error) {
    throw UsageError(
        fmt::format("{}:{}: not valid YAML ({})", path, error.mark.line + 1, error.msg));
  }
}

}  // namespace

RvizPicture ReadRvizFile(const std::string& path, int height_px) {
  return Read(path, height_px, [&] { return options::LoadYaml(path, kDeepest); });
}

RvizPicture ParseRvizFile(const std::string& path, const std::string& text, int height_px) {
  return Read(path, height_px, [&] { return options::ParseYaml(text, kDeepest); });
}

}  // namespace kinescope::app
