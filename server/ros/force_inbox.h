/// Receives one person's input topics: measured forces, external joint loads, hand loads
/// (docs/ros.md). The registration thread subscribes. The thread that reads samples calls the queue
/// and so receives the messages, which wait in the inbox for the next sample.
#pragma once

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <kinescope/HandLoad.h>
#include <kinescope/JointLoadArray.h>
#include <kinescope/SetHandLoad.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <sensor_msgs/JointState.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/ros/bridge.h"
#include "server/ros/force_frames.h"
#include "server/ros/force_input.h"

namespace kinescope::ros_bridge {

/// Settings that are the same for all people.
struct ForceSettings {
  std::string reference_frame;
  double external_scale = 1;
  std::function<std::string(const HandLoad&)> check_hand_load;  // null: all are accepted
  std::shared_ptr<const TfTree> tf;
  std::function<void()> want_tf;  // called for a frame that is unknown and not in `tf`; must not
                                  // block
};

class ForceInbox {
 public:
  explicit ForceInbox(ForceSettings settings) : settings_(std::move(settings)) {}

  // The following functions are for the thread that reads samples.

  /// Sets the newest sample of this inbox's person.
  void SetBody(const PersonState& person, double floor_z);
  /// Passes on new inputs.
  void Deliver(int character, InputSink& sink);

  void OnHandLoad(const kinescope_ros::HandLoad& message);
  bool OnSetHandLoad(kinescope_ros::SetHandLoad::Request& request,
                     kinescope_ros::SetHandLoad::Response& response);
  void OnHandWrench(urdf::Side side, const geometry_msgs::WrenchStamped& message);
  void OnFootWrench(urdf::Side side, const geometry_msgs::WrenchStamped& message);
  void OnGroundWrench(const geometry_msgs::WrenchStamped& message);
  void OnGroundCop(const geometry_msgs::PointStamped& message);
  void OnExternalLoads(const kinescope_ros::JointLoadArray& message);
  void OnExternalJointStates(const sensor_msgs::JointState& message);
  /// A message of `topic` that cannot be decoded.
  void OnUnreadable(const std::string& topic);

  /// By topic. Any thread.
  std::map<std::string, InputCounters> counters() const;

 private:
  // HandLoad, or the request of SetHandLoad, which has the same members. @return the error, ""
  // without one.
  template <class Message>
  std::string TakeHandLoad(const char* topic, const Message& message);
  std::optional<FoundFrame> Place(const char* topic, const std_msgs::Header& header);
  std::int64_t StampOf(const char* topic, const std_msgs::Header& header);
  void Refuse(const std::string& topic, const Refusal& refusal);
  void Use(const char* topic);
  void UseExternal(const char* topic, const Taken<ExternalLoads>& loads, std::int64_t stamp_nanos);
  void CombineGround();

  const ForceSettings settings_;

  // Used by the thread that reads samples only.
  std::optional<BodyNow> body_;
  std::string model_;
  Measurements measured_;
  std::optional<MeasuredGroundForce> ground_wrench_;
  std::optional<Eigen::Vector3d> ground_cop_;
  std::int64_t ground_cop_nanos_ = 0;
  bool has_news_ = false;
  std::optional<HandLoad> told_;

  mutable std::mutex mutex_;
  std::map<std::string, InputCounters> counters_;  // guarded by mutex_
};

/// The connections that fill an inbox; their destructors close them. A master that was restarted
/// needs new ones.
struct ForceSubscriptions {
  std::vector<ros::Subscriber> subscribers;
  ros::ServiceServer service;
  bool AreComplete() const;  // false: the master did not accept one of them
};

/// Subscribes below `prefix` ("" or "<model>/") of the private names of `node`. Calls the master,
/// so it may block.
ForceSubscriptions SubscribeForces(ros::NodeHandle& node, const std::string& prefix,
                                   ros::CallbackQueue& queue,
                                   const std::shared_ptr<ForceInbox>& inbox);

}  // namespace kinescope::ros_bridge
