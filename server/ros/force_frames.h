/// Where the frames are that forces are measured in: the reference frame, a link of the person, or
/// anything in /tf. One thread.
#pragma once

#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <cstdint>
#include <optional>
#include <string>

#include "core/scene_state.h"
#include "server/ros/names.h"

namespace kinescope::ros_bridge {

/// What other nodes say about frames, for ten seconds. Not our own: those are known from the newest
/// sample, and a recording that starts over would be old news to it.
class TfTree {
 public:
  /// What is no pose (a number that is not finite, a quaternion that is none) is left out; the
  /// number of those.
  int Add(const tf2_msgs::TFMessage& message, bool is_static);

  /// target_from_frame at `stamp_nanos`, or as it was seen last when that time is not known.
  std::optional<urdf::Pose> Find(const std::string& target, const std::string& frame,
                                 std::int64_t stamp_nanos) const;

 private:
  tf2::BufferCore buffer_;
};

/// The person whom sensors touch, as in the newest sample.
struct BodyNow {
  urdf::LinkPoses links{};  // world_from_link
  urdf::Skeleton skeleton;
  double floor_z = 0;
  std::int64_t stamp_nanos = 0;
};

struct FoundFrame {
  urdf::Pose pose;  // world_from_frame
  /// Of the reference frame or a link of the person: its origin is where no sensor sits.
  bool is_own = false;
};

/// `frame` as a link of `model` ("skeleton_right_hand", "right_hand", "RightHand"), the reference
/// frame, or in `tf` below either; nullopt when it is none of these.
std::optional<FoundFrame> FindFrame(const std::string& frame, std::int64_t stamp_nanos,
                                    const std::string& reference_frame, const std::string& model,
                                    const BodyNow& body, const TfTree& tf);

}  // namespace kinescope::ros_bridge
