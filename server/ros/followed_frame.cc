#include "server/ros/followed_frame.h"

namespace kinescope::ros_bridge {

bool FollowedFrame::Update(std::int64_t now_nanos, const FindFrame& find) {
  constexpr std::int64_t kEveryNanos = 16'000'000;
  if (!is_wanted()) return false;
  // A recording that is played again begins earlier.
  if (looked_nanos_ && now_nanos >= *looked_nanos_ && now_nanos - *looked_nanos_ < kEveryNanos) {
    return false;
  }
  looked_nanos_ = now_nanos;
  std::optional<urdf::Pose> found = find(frames_.at);
  if (!found) return false;
  if (!frames_.axes.empty()) {
    found->orientation = find(frames_.axes).value_or(urdf::Pose{}).orientation;
  }
  const bool is_same = pose_ && pose_->position == found->position &&
                       pose_->orientation.coeffs() == found->orientation.coeffs();
  pose_ = found;
  return !is_same;
}

}  // namespace kinescope::ros_bridge
