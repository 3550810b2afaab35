/// Frames of TF as RViz's TF display has them: axes, a name below them and an arrow to the parent.
/// One thread.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/graph_view.h"
#include "core/scene_marker.h"
#include "server/ros/force_frames.h"
#include "server/ros/now.h"
#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

inline constexpr std::size_t kMostShownFrames = 500;

class ShownFrames {
 public:
  using TakeFrame = std::function<void(const TreeFrame&)>;
  /// Gives all frames there are.
  using ListFrames = std::function<void(const TakeFrame& take)>;
  /// Where a frame is now, in the frame of the scene.
  using FindFrame = std::function<std::optional<urdf::Pose>(const std::string& frame)>;

  /// @param every_nanos  the frames are looked at no more often
  /// @param number  of several ways in which they are shown, from 0
  ShownFrames(const ShownStyle& style, std::int64_t every_nanos, int number = 0);

  /// True if the markers have changed. Of more than kMostShownFrames frames the first by name are
  /// shown. A frame whose transforms do not come any more turns grey, pale, and is gone after the
  /// timeout of the style, by the clock of the graph.
  bool Update(const Now& now, const ListFrames& list, const FindFrame& find);

  /// Axes, shafts and heads of all arrows, then the names, in the frame of the scene.
  const MarkerList& markers() const { return markers_; }

  /// "frames without a way to that of the scene: a, b", "frames in a loop or below it: c" and
  /// "frames beyond 50 km: d": those that are heard of and have been so for a second, each once;
  /// "": no further ones.
  [[nodiscard]] std::string TakeLost();

 private:
  struct Seen {
    std::string parent;
    std::int64_t newest_nanos = 0;  // stamp of its transform; 0: it always holds
    std::int64_t since_nanos = 0;   // clock of the graph
    std::int64_t listed_nanos = 0;  // then it was there
  };
  using Frame = std::pair<const std::string, Seen>;
  struct Shown {
    std::string name;
    urdf::Pose pose;
    std::optional<Eigen::Vector3d> parent;  // where the arrow ends
    double grey = 0, alpha = 1;             // of a frame that is not heard of
    bool operator==(const Shown& other) const;
  };

  enum class Why { kNoWay, kLoop, kFar };
  struct Lost {
    std::int64_t since_nanos = 0;
    Why why = Why::kNoWay;
  };

  /// Since it was last heard of, s.
  static double OwnAgeOf(const Seen& frame, const Now& now);
  /// Whether it is in a loop, or hangs on one.
  bool HasLoop(const Seen& frame) const;
  /// Of it, or of any that it hangs on.
  double AgeOf(const Seen& frame, const Now& now) const;
  /// `frames`: those that are not gone, by name.
  std::vector<Shown> Place(const std::vector<const Frame*>& frames, const FindFrame& find,
                           const Now& now);
  void Draw();

  ShownStyle style_;
  std::int64_t every_nanos_;
  int first_id_;  // of its markers
  std::optional<Now> looked_;
  std::unordered_map<std::string, Seen> seen_;
  std::vector<Shown> shown_;
  MarkerList markers_;
  std::map<std::string, Lost> lost_;
  std::set<std::string> told_;  // those of lost_ that were told
};

/// `markers`, then those of the frames.
MarkerList Together(MarkerList markers, const std::vector<ShownFrames>& frames);

}  // namespace kinescope::ros_bridge
