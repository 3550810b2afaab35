/// The frames of TF that a camera goes with. One thread.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "core/graph_view.h"
#include "urdf/kinematics.h"

namespace kinescope::ros_bridge {

class FollowedFrame {
 public:
  /// Where the frame is now, in the frame of the scene.
  using FindFrame = std::function<std::optional<urdf::Pose>(const std::string& frame)>;

  explicit FollowedFrame(CameraFrames frames) : frames_(std::move(frames)) {}

  bool is_wanted() const { return !frames_.at.empty(); }
  /// True if it has moved. Looks at most sixty times a second.
  bool Update(std::int64_t now_nanos, const FindFrame& find);
  /// Where it was last, as RViz has it; none before the first time. With the axes of the scene as
  /// long as those of `axes` are not known.
  const std::optional<urdf::Pose>& pose() const { return pose_; }

 private:
  /// Once, if the frame whose axes the camera has does not come.
  void TellOfAxes(bool is_there, std::int64_t now_nanos);

  const CameraFrames frames_;
  std::optional<urdf::Pose> pose_;
  std::optional<std::int64_t> looked_nanos_;
  std::optional<std::int64_t> without_axes_nanos_;  // since then
  bool has_told_ = false;
};

}  // namespace kinescope::ros_bridge
