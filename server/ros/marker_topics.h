/// Subscribes to the topics of external markers, counts their messages and passes the resulting
/// markers on: of visualization_msgs/Marker and MarkerArray, and of messages that are shown as
/// markers (shown_messages.h); and pictures of cameras. The type is the one that each connection
/// states.
#pragma once

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "core/scene_state.h"
#include "server/ros/bridge.h"
#include "server/ros/followed_frame.h"
#include "server/ros/force_frames.h"
#include "server/ros/image_box.h"
#include "server/ros/marker_input.h"
#include "server/ros/raw_message.h"
#include "server/ros/robot_inbox.h"
#include "server/ros/shown_frames.h"
#include "server/ros/topic_markers.h"

namespace kinescope::ros_bridge {

class MarkerInbox {
 public:
  /// At most kMostShownTopics. @throws UsageError with an invalid name. @pre InitRos was called.
  /// @param robots  whose links may be frames of markers, and whose efforts are shown; or null
  MarkerInbox(std::vector<ShownTopic> topics, std::string camera_frame, std::string reference_frame,
              std::shared_ptr<const TfTree> tf, std::shared_ptr<const RobotInbox> robots);

  const std::vector<ShownTopic>& topics() const { return topics_; }  // with their full names

  // The following functions are for the thread that reads samples.

  using Event = ros::MessageEvent<const RawMessage>;
  /// @param has_colors  of HeardTopic
  void OnMessage(std::size_t topic, const Event& event, bool has_colors,
                 std::int64_t monotonic_nanos);
  /// Sets a person whose links may be frames of markers.
  void SetPerson(const PersonState& person, double floor_z);
  /// Passes on the markers, the pictures and the camera's frame if they have changed.
  void Deliver(std::int64_t monotonic_nanos, InputSink& sink);

  /// By topic. Any thread.
  std::map<std::string, InputCounters> counters() const;

 private:
  struct Body {
    std::string model;
    BodyNow now;
  };

  void Take(std::size_t topic, const visualization_msgs::Marker& message,
            std::int64_t monotonic_nanos);
  void TakeImage(std::size_t topic, Taken<CameraImage> image, std::int64_t monotonic_nanos);
  void TakeCalibration(std::size_t topic, const std::vector<std::uint8_t>& bytes);
  void TakeShown(std::size_t topic, const std::string& md5sum,
                 const std::vector<std::uint8_t>& bytes, std::int64_t monotonic_nanos);
  void CountUsed(std::size_t topic);
  void Refuse(std::size_t topic, const Refusal& refusal);
  std::optional<urdf::Pose> Find(const std::string& frame, std::int64_t stamp_nanos) const;
  std::vector<const RobotFrames*> Robots() const;
  bool UpdateFrames(std::int64_t monotonic_nanos);

  const std::vector<ShownTopic> topics_;
  const std::string reference_frame_;
  const std::shared_ptr<const TfTree> tf_;
  const std::shared_ptr<const RobotInbox> robots_;

  // Used by the thread that reads samples only.
  MarkerStore store_;
  TopicMarkers shown_{[this](const std::string& joint) { return FindJointOf(Robots(), joint); }};
  ImageBox images_;
  FollowedFrame camera_frame_;
  std::optional<ShownFrames> frames_;
  std::map<int, Body> bodies_;             // by character
  visualization_msgs::Marker marker_;      // reused, keeps its memory
  visualization_msgs::MarkerArray array_;  // reused, keeps its memory

  mutable std::mutex mutex_;
  std::map<std::string, InputCounters> counters_;  // guarded by mutex_
};

/// The connections that fill an inbox; a master that was restarted needs new ones. Calls the
/// master, so it may block.
std::vector<ros::Subscriber> SubscribeMarkers(ros::NodeHandle& node, ros::CallbackQueue& queue,
                                              const std::shared_ptr<MarkerInbox>& inbox);

}  // namespace kinescope::ros_bridge
