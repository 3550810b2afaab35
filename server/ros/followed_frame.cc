#include "server/ros/followed_frame.h"

#include <spdlog/spdlog.h>

#include "core/system/clocks.h"

namespace kinescope::ros_bridge {

void FollowedFrame::TellOfAxes(bool is_there, std::int64_t now_nanos) {
  constexpr std::int64_t kPatience = 5 * kNanosPerSecond;
  if (is_there || has_told_ || frames_.axes == kUsualFrameOfRviz)
    return without_axes_nanos_.reset();
  if (!without_axes_nanos_ || now_nanos < *without_axes_nanos_) without_axes_nanos_ = now_nanos;
  if (now_nanos - *without_axes_nanos_ < kPatience) return;
  has_told_ = true;
  spdlog::warn("no frame '{}' has come (--camera_tf): the camera has the axes of the scene",
               frames_.axes);
}

bool FollowedFrame::Update(std::int64_t now_nanos, const FindFrame& find) {
  constexpr std::int64_t kEveryNanos = 16'000'000;
  if (!is_wanted()) return false;
  // A recording that is played again begins earlier.
  if (looked_nanos_ && now_nanos >= *looked_nanos_ && now_nanos - *looked_nanos_ < kEveryNanos) {
    return false;
  }
  looked_nanos_ = now_nanos;
  std::optional<urdf::Pose> axes;
  if (!frames_.axes.empty()) {
    axes = find(frames_.axes);
    TellOfAxes(axes.has_value(), now_nanos);
  }
  std::optional<urdf::Pose> found = find(frames_.at);
  if (!found) return false;
  if (!frames_.axes.empty()) found->orientation = axes.value_or(urdf::Pose{}).orientation;
  const bool is_same = pose_ && pose_->position == found->position &&
                       pose_->orientation.coeffs() == found->orientation.coeffs();
  pose_ = found;
  return !is_same;
}

}  // namespace kinescope::ros_bridge
