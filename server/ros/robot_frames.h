/// Where the links of a robot are, by the frames and the joint states of a ROS graph. World frame,
/// metres. One thread.
#pragma once

#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/graph_view.h"
#include "core/robot_state.h"
#include "urdf/kinematics.h"
#include "urdf/robot/robot_kinematics.h"

namespace kinescope::ros_bridge {

/// Robots that move are placed as often: enough for any frame rate.
inline constexpr std::int64_t kPlaceEveryNanos = 16'000'000;

/// The topic of the joint states of a robot whose URDF is a file: "/joint_states", with a TF prefix
/// "/<prefix>/joint_states".
std::string JointStatesOf(const GraphRobot& robot);

/// "<tf_prefix>/<link>"; without a prefix "<link>".
std::string FrameOfLink(const std::string& tf_prefix, const std::string& link);

class RobotFrames {
 public:
  using FindFrame = std::function<std::optional<urdf::Pose>(const std::string& frame)>;

  /// @pre `robot` has a model
  RobotFrames(RobotState robot, const std::string& tf_prefix);

  /// Takes the positions of its joints; the last ones of each count. Joints that it does not have,
  /// and positions that are not finite, are left out. False: none was used.
  bool Take(const sensor_msgs::JointState& message);

  /// Places each link at its frame. Where there is none, and joint states have come, the link is
  /// chained to its parent, and the root stands at the origin; else it is nowhere, and `problem`
  /// names it. True if anything has changed.
  bool Place(const FindFrame& find);

  /// The frame of the first link that would be seen and is nowhere; "": there is none.
  std::string FirstMissing() const;

  /// The frame of a link that is chained; nullopt: it is another one.
  std::optional<urdf::Pose> FindChained(const std::string& frame) const;

  /// Never null; another object after each change.
  const std::shared_ptr<const RobotState>& now() const { return now_; }

 private:
  const std::shared_ptr<const urdf::RobotModel> model_;
  std::vector<std::string> frames_;                     // of the links
  std::unordered_map<std::string, std::size_t> links_;  // by their frames
  std::vector<std::size_t> parents_;                    // of the links; of the root: itself
  std::unordered_set<std::string> moved_joints_;        // those with a position
  std::vector<bool> has_frame_;                         // of the links: TF has it
  urdf::JointPositions positions_;
  std::vector<Eigen::Isometry3d> chained_;  // root_from_link at positions_; empty before the first
  std::shared_ptr<const RobotState> now_;
};

/// Of the first robot that has such a link.
std::optional<urdf::Pose> FindChainedOf(const std::vector<const RobotFrames*>& robots,
                                        const std::string& frame);

}  // namespace kinescope::ros_bridge
