#include "server/ros/order_services.h"

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

constexpr double kPollSecs = 0.1;  // limits how soon the end is noticed

// @param order  gets the request, returns a RosAnswer
template <class Service, class Order>
ros::ServiceServer Offer(ros::NodeHandle& node, const char* name, ros::CallbackQueue& queue,
                         const Order& order) {
  using Request = BoundedMessage<typename Service::Request>;
  using Response = typename Service::Response;
  ros::AdvertiseServiceOptions options;
  options.init<Request, Response>(name, [order](Request& request, Response& response) {
    if (!request.is_sound) return false;
    const RosAnswer answer = order(request.message);
    response.success = answer.is_done;
    response.message = answer.text;
    return true;
  });
  options.callback_queue = &queue;
  return node.advertiseService(options);
}

}  // namespace

OrderServices::OrderServices(const RosOrders& orders) : orders_(orders) {
  thread_ = std::thread([this] {
    while (!stopping_) queue_.callOne(ros::WallDuration(kPollSecs));
  });
}

OrderServices::~OrderServices() {
  stopping_ = true;
  thread_.join();
  queue_.disable();
  queue_.clear();
}

void OrderServices::Advertise(ros::NodeHandle& node) {
  services_.clear();
  services_.push_back(Offer<std_srvs::Trigger>(
      node, "snapshot", queue_, [this](const auto& /*request*/) { return orders_.snapshot(); }));
  services_.push_back(Offer<std_srvs::SetBool>(node, "record", queue_, [this](const auto& request) {
    return orders_.record(request.data);
  }));
}

}  // namespace kinescope::ros_bridge
