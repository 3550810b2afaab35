#include "server/ros/order_services.h"

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "core/system/clocks.h"
#include "server/ros/offered_service.h"

namespace kinescope::ros_bridge {
namespace {

constexpr double kPollSecs = 0.1;  // limits how soon the end is noticed

}  // namespace

OrderServices::OrderServices(const RosOrders& orders, const RosSettings& settings,
                             const NodeTopics& topics)
    : orders_(orders) {
  if (settings.get) settings_.emplace(settings, topics.settings, topics.settings_now);
  thread_ = std::thread([this] {
    while (!stopping_) {
      queue_.callOne(ros::WallDuration(kPollSecs));
      if (settings_) settings_->Update(MonotonicNanos());
    }
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
  if (settings_) services_.push_back(settings_->Advertise(node, queue_));
  if (!orders_.snapshot) return;
  const auto say = [](const RosAnswer& answer, auto& response) {
    response.success = answer.is_done;
    response.message = answer.text;
  };
  services_.push_back(OfferService<std_srvs::Trigger>(
      node, "snapshot", queue_,
      [this, say](const auto& /*request*/, auto& response) { say(orders_.snapshot(), response); }));
  services_.push_back(OfferService<std_srvs::SetBool>(
      node, "record", queue_, [this, say](const auto& request, auto& response) {
        say(orders_.record(request.data), response);
      }));
}

}  // namespace kinescope::ros_bridge
