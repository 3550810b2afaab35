/// The robots of the graph: their URDFs, which the parameter server has, and the places of their
/// links, by /tf or by joint states.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "server/ros/bridge.h"
#include "server/ros/effort_rings.h"
#include "server/ros/force_frames.h"
#include "server/ros/frame_ways.h"
#include "server/ros/refusal.h"
#include "server/ros/robot_frames.h"
#include "server/ros/robot_loader.h"
#include "server/ros/scene_frame.h"

namespace kinescope::ros_bridge {

class RobotInbox {
 public:
  /// @param frame  in which the scene stands
  RobotInbox(std::vector<GraphRobot> wanted, std::shared_ptr<const SceneFrame> frame,
             std::shared_ptr<const TfTree> tf);

  std::size_t size() const { return wanted_.size(); }
  /// Full name of the parameter with the URDF of robot `i`; "": it is known.
  std::string ParameterOf(std::size_t i) const;
  /// Full name of the topic with its joint states.
  std::string JointStatesOf(std::size_t i) const;

  /// Takes the content of the parameter of robot `i`, as often as it is read; nullopt: it is not
  /// there, or no text. A robot with meshes on web servers is shown once they are loaded. One
  /// thread.
  void SetDescription(std::size_t i, const std::optional<std::string>& urdf);

  /// Why the parameter of robot `i` cannot be read. Any thread.
  void SetProblem(std::size_t i, const std::string& why);

  // The following functions are for the thread that reads samples.

  void OnJointStates(std::size_t i, const sensor_msgs::JointState& message);
  /// Places the links at `stamp_nanos`, where TF has that time; else, and with 0, at the newest.
  /// Passes the robots on if one has moved; at most sixty times a second.
  void Deliver(std::int64_t monotonic_nanos, std::int64_t stamp_nanos, InputSink& sink);

  /// Of the robots that are shown; until the next Deliver().
  std::vector<const RobotFrames*> Frames() const;

  /// Of the robots that are shown. Any thread.
  std::optional<ShownJoint> FindJoint(const std::string& name) const;

  /// By robot: "robot /robot_description". Any thread.
  std::map<std::string, InputCounters> counters() const;
  /// Links that have had no place for a while, as those of markers in MarkerInbox. Any thread.
  std::vector<std::string> not_shown() const;

 private:
  struct Slot {
    std::optional<RobotFrames> frames;
    std::string warned_of;
    std::int64_t incomplete_nanos = 0;  // since then something is missing; 0: nothing is
  };

  void ListJoints();
  void WarnOfMissing(std::size_t i);
  void Warn(std::size_t i, std::int64_t monotonic_nanos);
  std::string NameOf(std::size_t i) const;
  void Refuse(std::size_t i, const Refusal& refusal);  // who calls it has logged it
  /// Shows it from the next Deliver() on. Any thread.
  void TakeUp(std::size_t i, RobotState robot);

  const std::vector<GraphRobot> wanted_;
  const std::shared_ptr<const SceneFrame> frame_;
  const std::shared_ptr<const TfTree> tf_;

  // Used by the thread that reads samples only.
  std::vector<Slot> slots_;  // as wanted_
  std::int64_t placed_nanos_ = 0;
  bool has_news_ = false;

  mutable std::mutex mutex_;
  std::map<std::size_t, RobotState> loaded_;       // guarded by mutex_; until taken up
  std::vector<std::optional<std::string>> texts_;  // guarded by mutex_; of the parameters
  std::map<std::size_t, std::int64_t> missed_;     // guarded by mutex_; since when; monotonic clock
  ShownJoints joints_;                             // guarded by mutex_; of slots_
  std::map<std::string, InputCounters> counters_;  // guarded by mutex_
  std::map<std::size_t, std::string> not_shown_;   // guarded by mutex_
  std::unique_ptr<RobotLoader> loader_;  // of SetDescription(); null: it was not needed yet
};

/// The topics of joint states; a master that was restarted needs new ones. Calls the master, so it
/// may block.
std::vector<ros::Subscriber> SubscribeJointStates(ros::NodeHandle& node, ros::CallbackQueue& queue,
                                                  const std::shared_ptr<RobotInbox>& inbox);

}  // namespace kinescope::ros_bridge
