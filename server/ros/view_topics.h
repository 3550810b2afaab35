/// `~view/image_raw` through image_transport (compressed, theora ... where their plugins are
/// installed), `~view/camera_info` and the frame of the camera on /tf. Who listens is told by the
/// connections themselves.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

class ViewTopics {
 public:
  /// How many connections there are now, of image, transports of it and camera_info together. On
  /// the thread that calls the queue.
  using OnListeners = std::function<void(int count)>;

  /// Advertises below the private names of `node`. Asks the master: may wait. Where image_transport
  /// finds none of its own plugins the plain topics are there all the same, and that is logged.
  ViewTopics(const ros::NodeHandle& node, ros::CallbackQueue& queue, std::string reference_frame,
             OnListeners on_listeners);
  ~ViewTopics();
  ViewTopics(const ViewTopics&) = delete;
  ViewTopics& operator=(const ViewTopics&) = delete;

  /// All that was advertised, with types: for a master that has forgotten it.
  std::map<std::string, std::string> TypesByTopic() const;

  /// The frame first: whoever gets the picture can look it up. One thread.
  void Publish(const ViewPicture& picture);

 private:
  struct Parts;  // image_transport's types
  const std::unique_ptr<Parts> parts_;
};

}  // namespace kinescope::ros_bridge
