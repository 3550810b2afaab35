/// Offers a service of ROS whose requests are untrusted.
#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>

#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {

/// `answer` is called from `queue` with the request and the response; a request that is truncated,
/// or has a wrong length field, gets none. It may block; registration thread only.
template <class Service, class Answer>
ros::ServiceServer OfferService(ros::NodeHandle& node, const char* name, ros::CallbackQueue& queue,
                                const Answer& answer) {
  using Request = BoundedMessage<typename Service::Request>;
  using Response = typename Service::Response;
  ros::AdvertiseServiceOptions options;
  options.init<Request, Response>(name, [answer](Request& request, Response& response) {
    if (!request.is_sound) return false;
    answer(request.message, response);
    return true;
  });
  options.callback_queue = &queue;
  return node.advertiseService(options);
}

}  // namespace kinescope::ros_bridge
