/// Live settings over ROS as dynamic_reconfigure has them: `~set_parameters`,
/// `~parameter_descriptions` and `~parameter_updates`. One thread, except Advertise().
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include <cstdint>
#include <optional>

#include "core/system/line_limit.h"
#include "server/ros/bridge.h"

namespace kinescope::ros_bridge {

class SettingsServer {
 public:
  /// Both publishers are latched.
  SettingsServer(const RosSettings& settings, const ros::Publisher& descriptions,
                 const ros::Publisher& updates);

  /// Requests are answered from `queue`. It may block; registration thread only.
  ros::ServiceServer Advertise(ros::NodeHandle& node, ros::CallbackQueue& queue);

  /// Publishes once a second what was changed elsewhere. Call it regularly.
  void Update(std::int64_t now_nanos);

 private:
  dynamic_reconfigure::Config Set(const dynamic_reconfigure::Config& wanted);
  void Look();
  void Publish();

  const RosSettings settings_;
  const ros::Publisher descriptions_, updates_;
  std::int64_t due_nanos_ = 0;
  LineLimit refusals_;
  std::int64_t settled_nanos_ = 0;    // until then orders take effect
  std::optional<LiveSettings> seen_;  // when it was last looked
  LiveSettings current_;              // with what was ordered since. @pre seen_
};

}  // namespace kinescope::ros_bridge
