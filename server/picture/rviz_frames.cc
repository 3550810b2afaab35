#include "server/picture/rviz_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "core/suit_colors.h"
#include "server/options/ros_names.h"
#include "server/options/text.h"
#include "server/picture/rviz_values.h"

namespace kinescope::app::rviz {
namespace {

constexpr Rgb kGridColor = {160.0 / 255, 160.0 / 255, 164.0 / 255};
template <class T>
using Read = tl::expected<T, std::string>;  // or why not

constexpr double kFarthestGrid = 1000;  // m

// The items of "(a=1,b=2)".
class Style {
 public:
  void Add(const std::string& item) { text_ += (text_.empty() ? "" : ",") + item; }
  void Add(const char* key, double value) { Add(std::string(key) + options::NumberText(value)); }
  void AddUnless(double usual, const char* key, double value) {
    if (value != usual) Add(key, value);
  }
  [[nodiscard]] std::string Text() const { return text_.empty() ? "" : "(" + text_ + ")"; }

 private:
  std::string text_;
};

class FrameDisplayReader {
 public:
  FrameDisplayReader(const YAML::Node& display, const std::string& fixed_frame,
                     std::vector<std::string>& remarks)
      : display_(display), fixed_frame_(fixed_frame), remarks_(remarks) {}

  Read<FrameDisplay> ReadGrid() {
    const Read<Frame> frame = ReferenceFrame();
    if (!frame) return tl::unexpected(frame.error());
    const std::string plane = TextOf(display_, "Plane", "XY");
    const Eigen::Vector3d offset = VectorOf(display_, "Offset");
    AddCells();
    if (plane == "XZ") style_.Add("plane=xz");
    if (plane == "YZ") style_.Add("plane=yz");
    if (offset.cwiseAbs().maxCoeff() > kFarthestGrid) {
      remarks_.emplace_back("its Offset is too far, and is not taken");
    } else if (!offset.isZero()) {
      style_.Add(fmt::format("at={}|{}|{}", options::NumberText(offset.x()),
                             options::NumberText(offset.y()), options::NumberText(offset.z())));
    }
    AddLines();
    if (!frame->name.empty()) style_.Add(frame->is_fixed ? "missing=scene" : "missing=origin");
    FrameDisplay grid{kGridInFrame + frame->name, style_.Text()};
    grid.is_floor = plane != "XZ" && plane != "YZ";
    grid.floor_differs = !frame->is_fixed || !offset.isZero();
    return grid;
  }

  Read<FrameDisplay> ReadAxes() {
    const Read<Frame> frame = ReferenceFrame();
    if (!frame) return tl::unexpected(frame.error());
    if (BoolOf(display_, "Show Trail", false)) remarks_.emplace_back("it has no trail");
    style_.Add("size=", Limited(display_, "Length", 1, kSmallestShown, kLargestShown));
    style_.Add("width=", Limited(display_, "Radius", 0.1, kSmallestShown, kLargestShown));
    style_.AddUnless(1, "alpha=", NumberOf(display_, "Alpha", 1, 0, 1));
    if (frame->is_fixed && !frame->name.empty()) style_.Add("missing=scene");
    return FrameDisplay{kAxesOfFrame + frame->name, style_.Text()};
  }

  FrameDisplay ReadTf() {
    for (const char* const filter : {"Filter (whitelist)", "Filter (blacklist)"}) {
      if (TextOf(display_, filter, "").empty()) continue;
      remarks_.push_back(std::string(filter) + " is not taken: all frames are drawn");
    }
    constexpr double kLength = 0.2;  // m, of an axis of the scale 1
    const double length = kLength * NumberOf(display_, "Marker Scale", 1,
                                             2 * kSmallestShown / kLength, kLargestShown / kLength);
    style_.Add("color=#ffffff");
    style_.Add("size=", length);
    style_.Add("text=", length / 2);
    style_.AddUnless(1, "alpha=", NumberOf(display_, "Marker Alpha", 1, 0, 1));
    const std::initializer_list<std::pair<const char*, const char*>> switches = {
        {"Show Axes", "axes=off"}, {"Show Names", "names=off"}, {"Show Arrows", "arrows=off"}};
    for (const auto& [property, off] : switches) {
      if (!BoolOf(display_, property, true)) style_.Add(off);
    }
    style_.Add("timeout=", NumberOf(display_, "Frame Timeout", 15, 1, kLongestFrameTimeout));
    AddHiddenFrames();
    FrameDisplay frames{std::string(kAxesOfFrame) + kEveryFrame, style_.Text()};
    frames.is_every_frame = true;
    frames.has_axes = BoolOf(display_, "Show Axes", true);
    return frames;
  }

 private:
  struct Frame {
    std::string name;  // "": that of the scene
    bool is_fixed = false;
  };
  Read<Frame> ReferenceFrame() {
    const std::string saved = FrameOf(display_, "Reference Frame", "<Fixed Frame>");
    const bool is_fixed = saved == "<Fixed Frame>" || saved == fixed_frame_;
    std::string name = is_fixed ? fixed_frame_ : saved;
    if (name.empty() || IsFrameName(name)) return Frame{std::move(name), is_fixed};
    return tl::unexpected(Quoted(name) + " is no name of a frame");
  }

  // Named, where the file has another number.
  double Limited(const YAML::Node& of, const char* property, double usual, double least,
                 double most) {
    const Limit limit = LimitOf(of, property, usual, least, most);
    if (!limit.remark.empty()) remarks_.push_back(limit.remark);
    return limit.value;
  }

  void AddCells() {
    style_.AddUnless(1, "size=", Limited(display_, "Cell Size", 1, kSmallestShown, kLargestShown));
    // As of a text, of which a number with a fraction is none.
    const auto whole = [&](const char* property, double usual, double least, double most) {
      const double value = Limited(display_, property, usual, least, most);
      return value == std::floor(value) ? value : least;
    };
    const double layers = whole("Normal Cell Count", 0, 0, kMostGridLayers);
    const int most = layers > 0 ? kMostLayeredCells : kMostGridCells;
    style_.AddUnless(10, "cells=", whole("Plane Cell Count", 10, 1, most));
    style_.AddUnless(0, "layers=", layers);
  }

  void AddLines() {
    const Rgb color = ColorOf(display_, "Color", kGridColor);
    if (color != kGridColor) style_.Add("color=" + ToHex(color));
    const double alpha = NumberOf(display_, "Alpha", 0.5, 0, 1);
    if (alpha == 0) remarks_.push_back(NotSeen(display_));
    style_.AddUnless(0.5, "alpha=", alpha);
    const YAML::Node lines = Member(display_, "Line Style");
    if (TextOf(lines, "Value", "Lines") != "Billboards") return;
    style_.AddUnless(0,
                     "width=", Limited(lines, "Line Width", 0.03, kSmallestShown, kLargestShown));
  }

  // "without=a|b"
  void AddHiddenFrames() {
    const YAML::Node frames = Member(display_, "Frames");
    if (!frames.IsDefined() || !frames.IsMap()) return;
    std::string names;
    for (const auto& frame : frames) {
      if (!frame.first.IsScalar() || BoolOf(frame.second, "Value", true)) continue;
      const std::string name = frame.first.as<std::string>();
      if (name == "All Enabled") continue;  // what the last click on it was: no frame
      if (IsFrameName(name)) {
        names += (names.empty() ? "" : "|") + name;
      } else {
        remarks_.push_back("the frame " + Quoted(name) + " is not left out");
      }
    }
    if (!names.empty()) style_.Add("without=" + names);
  }

  const YAML::Node display_;
  const std::string& fixed_frame_;
  std::vector<std::string>& remarks_;
  Style style_;
};

}  // namespace

bool IsFrameDisplay(const std::string& kind) {
  return kind == "rviz/Grid" || kind == "rviz/Axes" || kind == "rviz/TF";
}

Read<FrameDisplay> FrameDisplayOf(const YAML::Node& display, const std::string& kind,
                                  const std::string& fixed_frame,
                                  std::vector<std::string>& remarks) {
  FrameDisplayReader reader(display, fixed_frame, remarks);
  if (kind == "rviz/Grid") return reader.ReadGrid();
  if (kind == "rviz/Axes") return reader.ReadAxes();
  return reader.ReadTf();
}

}  // namespace kinescope::app::rviz
