/// Names of ROS in options, whether or not this build has ROS: as roscpp has them, letters, digits,
/// _ and /. Pure functions, any thread.
#pragma once

#include <string>
#include <vector>

#include "core/graph_view.h"
#include "server/options/value.h"

namespace kinescope::app {

inline constexpr double kLargestStep = 1000;                         // of EarlierMessages, m or rad
inline constexpr double kLargestBound = 1e12;                        // of PointScale
inline constexpr double kSmallestShown = 0.001, kLargestShown = 10;  // m, of ShownStyle::size_m
inline constexpr double kSmallestPixels = 1, kLargestPixels = 100;   // of ShownStyle::size_px
inline constexpr double kLongestArrow = 1000;                        // m for 1 N or 1 N·m
inline constexpr double kLongestFrameTimeout = 1e6;                  // s
inline constexpr double kLargestCovarianceScale = 1000;

/// A topic or a parameter: it begins with a letter, / or ~.
[[nodiscard]] bool IsTopicName(const std::string& text);
[[nodiscard]] bool IsTopicNameOrEmpty(const std::string& text);
inline constexpr char kTopicNameExpected[] = "the name of a topic, such as /human/tf";
inline constexpr char kTfTopicHelp[] =
    "topic of the transforms of a bag, where people are looked for; default: /tf";
/// Before the name of a frame among topics: its axes are shown; before kEveryFrame: all frames.
inline constexpr char kAxesOfFrame[] = "tf:";
/// The same: a grid in the frame is shown.
inline constexpr char kGridInFrame[] = "grid:";
/// Among topics: markers of a bag that come on none of them are not shown.
inline constexpr char kNoOtherTopics[] = "-*";
/// A frame, or the prefix of frames: not with / at its beginning.
[[nodiscard]] bool IsFrameName(const std::string& text);
/// A field of a cloud: letters, digits and _.
[[nodiscard]] bool IsFieldName(const std::string& text);
/// Topics to show: "/walls,/cloud(color=#ff8800,alpha=0.5,size=0.02),/goal(shape=axes)"; points by
/// a number of theirs: "/scan(by=z,from=0,to=2,low=#000000,high=#ffffff)",
/// "/c(by=ring,rainbow=inverted,pixels=3)"; arrows of a wrench:
/// "/push(force=0.002,torque=0,width=0.3)"; axes: "tf:base_link(size=0.5)",
/// "tf:*(names=off,arrows=off,timeout=5,without=left|right)"; grids:
/// "grid:(size=0.5,cells=20,layers=2,plane=xz,at=0|0|-0.9,color=#a0a0a4,alpha=0.5,width=0.01)".
class ShownTopicsValue : public options::ValueOf<std::vector<ShownTopic>> {
 public:
  ShownTopicsValue() : ValueOf({}) {}

  void Parse(const std::string& text) override;
  std::string ToText() const override { return text_; }
  std::string Expected() const override;

 private:
  std::string text_;
};

}  // namespace kinescope::app
