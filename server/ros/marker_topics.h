/// Subscribes to the topics of external markers, counts their messages and passes the resulting
/// markers on: of visualization_msgs/Marker and MarkerArray, and of messages that are shown as
/// markers (shown_messages.h); and pictures of cameras. The type is the one that each connection
/// states.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "core/graph_view.h"
#include "core/scene_state.h"
#include "server/ros/bridge.h"
#include "server/ros/followed_frame.h"
#include "server/ros/force_frames.h"
#include "server/ros/image_box.h"
#include "server/ros/marker_decoder.h"
#include "server/ros/marker_input.h"
#include "server/ros/robot_inbox.h"
#include "server/ros/scene_frame.h"
#include "server/ros/shown_frames.h"

namespace kinescope::ros_bridge {

class MarkerInbox {
 public:
  /// At most kMostShownTopics. @throws UsageError with an invalid name. @pre InitRos was called.
  /// @param frame  in which the scene stands
  /// @param robots  whose links may be frames of markers, and whose efforts are shown; or null
  MarkerInbox(std::vector<ShownTopic> topics, CameraFrames camera_frame,
              std::shared_ptr<const SceneFrame> frame, std::shared_ptr<const TfTree> tf,
              std::shared_ptr<const RobotInbox> robots);

  const std::vector<ShownTopic>& topics() const { return topics_; }  // with their full names

  // The following two functions are for the thread that listens to the topics.

  /// @param has_colors  of HeardTopic
  void OnMessage(std::size_t topic, const MarkerDecoder::Event& event, bool has_colors,
                 std::int64_t monotonic_nanos);
  /// After the messages that were there.
  void FinishMessages();

  /// Erases what the topics of this name have. Any thread.
  void Erase(const std::string& name);

  // The following functions are for the thread that reads samples.

  /// See MarkerStore::FirstFrame().
  std::string FirstFrame() const { return store_.FirstFrame(); }
  /// Sets a person whose links may be frames of markers.
  void SetPerson(const PersonState& person, double floor_z);
  /// Passes on the markers, the pictures and the camera's frame if they have changed.
  void Deliver(const Now& now, InputSink& sink);

  /// By topic. Any thread.
  std::map<std::string, InputCounters> counters() const;
  /// What has stood in an unknown frame for five seconds or more: "/cloud: marker ...: frame
  /// 'lidar' is not known yet". Any thread.
  std::vector<std::string> not_shown() const;

 private:
  struct Body {
    std::string model;
    BodyNow now;
  };

  void PassOn();
  void TakeDecoded(std::int64_t graph_nanos);
  void Take(DecodedMessage& message, std::int64_t graph_nanos);
  void Take(std::size_t topic, const visualization_msgs::Marker& message, const Now& now);
  void TakeImage(std::size_t topic, CameraImage image);
  void CountUsed(std::size_t topic);
  void Refuse(std::size_t topic, const Refusal& refusal);
  void WarnOfUnplaced(std::int64_t monotonic_nanos);
  void TellOfOtherTree(const std::string& frame);
  std::string TextOf(const WithoutPlace& lost) const;
  std::optional<FramePlace> Find(const std::string& frame, std::int64_t stamp_nanos) const;
  std::vector<const RobotFrames*> Robots() const;
  bool UpdateFrames(const Now& now);

  const std::vector<ShownTopic> topics_;
  const std::shared_ptr<const SceneFrame> frame_;
  std::string placed_in_;  // what frame_ was when markers were placed
  const std::shared_ptr<const TfTree> tf_;
  const std::shared_ptr<const RobotInbox> robots_;

  MarkerDecoder decoder_;  // used by the thread that listens only

  // Used by the thread that reads samples only.
  std::deque<DecodedMessage> taken_;  // of decoded_; what there was no time for
  MarkerStore store_;
  ImageBox images_;
  FollowedFrame camera_frame_;
  std::vector<ShownFrames> frames_;
  std::map<int, Body> bodies_;  // by character
  std::int64_t looked_nanos_ = 0;
  std::int64_t graph_nanos_ = 0;             // of the newest Deliver()
  std::set<std::string> unplaced_, warned_;  // texts: when it looked last; of the log
  bool has_told_of_trees_ = false;

  mutable std::mutex mutex_;
  std::deque<DecodedMessage> decoded_;             // guarded by mutex_
  std::size_t waiting_ = 0;                        // guarded by mutex_; in decoded_ and taken_
  std::map<std::string, InputCounters> counters_;  // guarded by mutex_
  std::vector<std::string> not_shown_;             // guarded by mutex_
};

/// Calls the callbacks of an inbox on a thread of its own.
class MarkerListener {
 public:
  explicit MarkerListener(std::shared_ptr<MarkerInbox> inbox);
  ~MarkerListener();
  MarkerListener(const MarkerListener&) = delete;
  MarkerListener& operator=(const MarkerListener&) = delete;

  const std::shared_ptr<MarkerInbox>& inbox() const { return inbox_; }
  ros::CallbackQueue& queue() { return queue_; }

 private:
  void Run();

  const std::shared_ptr<MarkerInbox> inbox_;
  ros::CallbackQueue queue_;
  std::atomic<bool> stops_ = false;
  std::thread thread_;
};

/// The connections that fill an inbox; a master that was restarted needs new ones. Calls the
/// master, so it may block.
std::vector<ros::Subscriber> SubscribeMarkers(ros::NodeHandle& node, MarkerListener& listener);

}  // namespace kinescope::ros_bridge
