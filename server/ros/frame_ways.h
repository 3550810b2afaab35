/// What frames of TF hang on, and why there is no way from one to another. Pure functions, any
/// thread.
#pragma once

#include <cstddef>
#include <string>
#include <unordered_map>

#include "server/ros/force_frames.h"

namespace kinescope::ros_bridge {

/// The root of the tree that `near` is part of; without such a frame that of the tree with most
/// frames. "": there are no frames.
[[nodiscard]] std::string RootOf(const std::unordered_map<std::string, TreeFrame>& frames,
                                 const std::string& near);

/// Why `frame` has no place in `target`, in one line: "frame 'lidar' is not known yet", "frame
/// 'lidar' hangs on 'cart', which has no way to 'world' in TF", "frame 'lidar' is in a loop of TF:
/// lidar, cart, lidar", that its transforms were skipped, or have no time in common.
[[nodiscard]] std::string WhyNotFound(const TfTree& tf, const std::string& frame,
                                      const std::string& target);

/// The root of the tree of `frame`, if that of `target` is another one; else "".
[[nodiscard]] std::string OtherTreeOf(const TfTree& tf, const std::string& frame,
                                      const std::string& target);

/// Something of a topic that has no place, since its frame has none.
struct WithoutPlace {
  std::size_t topic = 0;
  std::string what;   // "marker walls/3"
  std::string frame;  // "": it has no place for another reason, which `what` gives
  std::string note;   // "; it stands at the origin of the scene"; or ""

  /// "marker walls/3: frame 'lidar' is not known yet".
  [[nodiscard]] std::string Text(const TfTree& tf, const std::string& target) const {
    return frame.empty() ? what : what + ": " + WhyNotFound(tf, frame, target) + note;
  }
};

}  // namespace kinescope::ros_bridge
