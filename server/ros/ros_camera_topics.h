/// Publishes `~view/image_raw` through image_transport (compressed, theora ... if their plugins are
/// installed), `~view/camera_info` and the frame of the camera on /tf. The subscribers are counted
/// from their connections.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

class RosCameraTopics {
 public:
  /// Number of connections, of image, its transports and camera_info together. Called on the thread
  /// that calls the queue.
  using OnListeners = std::function<void(int count)>;

  /// Advertises below the private names of `node`. Calls the master, so it may block. If
  /// image_transport finds no plugins, the plain topics are advertised all the same, which is
  /// logged.
  RosCameraTopics(const ros::NodeHandle& node, ros::CallbackQueue& queue,
                  std::string reference_frame, OnListeners on_listeners);
  ~RosCameraTopics();
  RosCameraTopics(const RosCameraTopics&) = delete;
  RosCameraTopics& operator=(const RosCameraTopics&) = delete;

  /// All advertised topics with their types, to register them again at a restarted master.
  std::map<std::string, std::string> TypesByTopic() const;

  /// Publishes the frame first, so that a receiver of the picture can look it up. Call it on one
  /// thread.
  void Publish(const RosImage& picture);

 private:
  struct Parts;  // types of image_transport
  const std::unique_ptr<Parts> parts_;
};

}  // namespace kinescope::ros_bridge
