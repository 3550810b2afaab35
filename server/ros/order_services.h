/// The services by which ROS orders what operators order on the page: `~snapshot`, `~record`, and
/// those of dynamic_reconfigure.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>

#include <atomic>
#include <optional>
#include <thread>
#include <vector>

#include "server/ros/bridge.h"
#include "server/ros/node_topics.h"
#include "server/ros/settings_server.h"

namespace kinescope::ros_bridge {

/// Carries orders out on a thread of its own: drawing takes time, and samples go on meanwhile.
class OrderServices {
 public:
  /// Of `orders` and `settings` those that are there; `topics`: of the settings.
  OrderServices(const RosOrders& orders, const RosSettings& settings, const NodeTopics& topics);
  ~OrderServices();  // waits for the order that is carried out
  OrderServices(const OrderServices&) = delete;
  OrderServices& operator=(const OrderServices&) = delete;

  /// At a master that does not know them; it may block. Registration thread only.
  void Advertise(ros::NodeHandle& node);

 private:
  const RosOrders orders_;
  std::optional<SettingsServer> settings_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> services_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;  // last
};

}  // namespace kinescope::ros_bridge
