#include "server/ros/settings_server.h"

#include <dynamic_reconfigure/Reconfigure.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "core/system/clocks.h"
#include "server/ros/offered_service.h"
#include "server/ros/settings_messages.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kLookEvery = kNanosPerSecond;
constexpr std::int64_t kSettles = kNanosPerSecond;  // what was ordered, one after the other

template <class Value>
void TakeIfChanged(const Value& before, const Value& now, Value& to) {
  if (now != before) to = now;
}

}  // namespace

SettingsServer::SettingsServer(const RosSettings& settings, const ros::Publisher& descriptions,
                               const ros::Publisher& updates)
    : settings_(settings), descriptions_(descriptions), updates_(updates) {}

ros::ServiceServer SettingsServer::Advertise(ros::NodeHandle& node, ros::CallbackQueue& queue) {
  return OfferService<dynamic_reconfigure::Reconfigure>(
      node, "set_parameters", queue,
      [this](const auto& request, auto& response) { response.config = Set(request.config); });
}

void SettingsServer::Update(std::int64_t now_nanos) {
  if (now_nanos < due_nanos_) return;
  due_nanos_ = now_nanos + kLookEvery;
  Look();
}

void SettingsServer::Look() {
  const std::optional<LiveSettings> now = settings_.get();
  if (!now) return;
  if (!seen_) {
    seen_ = current_ = *now;
    descriptions_.publish(DescribeSettings(*now, settings_.cameras));
    return Publish();
  }
  if (*now != current_ && MonotonicNanos() < settled_nanos_) return;
  const LiveSettings before = *seen_, old = current_;
  TakeIfChanged(before.class_limits, now->class_limits, current_.class_limits);
  TakeIfChanged(before.mass_kg, now->mass_kg, current_.mass_kg);
  TakeIfChanged(before.height_m, now->height_m, current_.height_m);
  TakeIfChanged(before.sex, now->sex, current_.sex);
  TakeIfChanged(before.camera, now->camera, current_.camera);
  seen_ = *now;
  if (current_ != old) Publish();
}

void SettingsServer::Publish() { updates_.publish(ToConfig(current_)); }

// An order takes effect with one of the next samples, so what was ordered is the answer, also of an
// order that follows at once.
dynamic_reconfigure::Config SettingsServer::Set(const dynamic_reconfigure::Config& config) {
  Look();
  if (!seen_) return {};
  WantedSettings wanted = ReadConfig(config, current_, settings_.cameras);
  const auto order = [&](const SettingsChange& change) {
    const RosAnswer answer = settings_.change(change);
    if (!answer.is_done) wanted.refused.push_back(answer.text);
    if (answer.is_done) settled_nanos_ = MonotonicNanos() + kSettles;
    return answer.is_done;
  };
  const SettingsChange& change = wanted.change;
  if (change.class_limits && order({change.class_limits, {}, {}})) {
    current_.class_limits = wanted.all.class_limits;
  }
  if (change.camera && order({{}, {}, change.camera})) current_.camera = wanted.all.camera;
  if (!change.person.is_empty() && order({{}, change.person, {}})) {
    current_.mass_kg = wanted.all.mass_kg;
    current_.height_m = wanted.all.height_m;
    current_.sex = wanted.all.sex;
  }
  if (!wanted.refused.empty()) {
    const std::string told = refusals_.Pass(
        fmt::format("not set over ROS: {}", fmt::join(wanted.refused, "; ")), MonotonicNanos());
    if (!told.empty()) spdlog::warn("{}", told);
  }
  Publish();
  return ToConfig(current_);
}

}  // namespace kinescope::ros_bridge
