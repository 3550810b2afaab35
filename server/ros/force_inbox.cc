#include "server/ros/force_inbox.h"

#include <ros/advertise_service_options.h>
#include <ros/subscribe_options.h>
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <utility>

#include "core/system/clocks.h"
#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"

namespace kinescope::ros_bridge {
namespace {

constexpr char kHandLoad[] = "hand_load";
constexpr char kSetHandLoad[] = "set_hand_load";
constexpr std::array<const char*, 2> kHandWrench = {"hand_wrench/right", "hand_wrench/left"};
constexpr std::array<const char*, 2> kFootWrench = {"foot_wrench/right", "foot_wrench/left"};
constexpr char kGroundWrench[] = "ground_wrench";
constexpr char kGroundCop[] = "ground_cop";
constexpr char kExternalLoads[] = "external_loads";
constexpr char kExternalJointStates[] = "external_joint_states";

Refusal NoPersonYet() {
  return {"no person", "no person has been received yet", /*is_in_log=*/false};
}

// Only the newest message counts of a sensor that is faster than the suit.
constexpr std::uint32_t kForceQueue = 32;

// Whether two measurements have about the same time.
bool AreOfOneTime(std::int64_t a, std::int64_t b) { return std::abs(Secs(a - b)) <= kMaxSkewSecs; }

}  // namespace

void ForceInbox::SetBody(const PersonState& person, double floor_z) {
  model_ = person.model->human.model_name;
  body_ = BodyNow{person.links, person.model->human.skeleton, floor_z, person.sample.stamp_nanos};
}

void ForceInbox::Deliver(int character, InputSink& sink) {
  if (told_) {
    sink.OnHandLoad(character, *told_);
    told_.reset();
  }
  if (!has_news_) return;
  has_news_ = false;
  sink.OnMeasurements(character, measured_);
}

std::map<std::string, InputCounters> ForceInbox::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

void ForceInbox::Use(const char* topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_[topic].received;
  ++counters_[topic].used;
}

void ForceInbox::Refuse(const std::string& topic, const Refusal& refusal) {
  bool is_first = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_first = CountRefused(refusal, counters_[topic]);
  }
  if (is_first) WarnOfRefused(topic, refusal);
}

// A header without a time counts as new as the sample; the result is compared with the sample's
// stamp.
std::int64_t ForceInbox::StampOf(const char* topic, const std_msgs::Header& header) {
  if (header.stamp.isZero()) return body_->stamp_nanos;
  const auto stamp = static_cast<std::int64_t>(header.stamp.toNSec());
  const double skew = Secs(stamp - body_->stamp_nanos);
  if (std::abs(skew) <= kMaxSkewSecs) return stamp;
  const std::lock_guard<std::mutex> lock(mutex_);
  InputCounters& counters = counters_[topic];
  ++counters.skewed;
  if (std::abs(skew) > std::abs(counters.worst_skew_secs)) counters.worst_skew_secs = skew;
  counters.last_problem = fmt::format(
      "time stamp differs by {:+.3f} s from the newest sample; synchronise the clocks", skew);
  return stamp;
}

std::optional<FoundFrame> ForceInbox::Place(const char* topic, const std_msgs::Header& header) {
  if (!body_) {
    Refuse(topic, NoPersonYet());
    return std::nullopt;
  }
  const auto stamp = static_cast<std::int64_t>(header.stamp.toNSec());
  auto frame =
      FindFrame(header.frame_id, stamp, settings_.reference_frame, model_, *body_, *settings_.tf);
  if (!frame) {
    settings_.want_tf();
    Refuse(topic,
           {"unknown frame",
            fmt::format(
                "unknown frame '{}': it is neither '{}' nor a link, and /tf does not contain it",
                header.frame_id.substr(0, 64), settings_.reference_frame)});
  }
  return frame;
}

template <class Message>
std::string ForceInbox::TakeHandLoad(const char* topic, const Message& message) {
  HandLoad load;
  std::string wrong = ReadHandLoad(message, load);
  if (wrong.empty() && settings_.check_hand_load) wrong = settings_.check_hand_load(load);
  if (!wrong.empty()) {
    Refuse(topic, {"bad load", wrong});
    return wrong;
  }
  Use(topic);
  told_ = load;
  return "";
}

void ForceInbox::OnHandLoad(const kinescope_ros::HandLoad& message) {
  TakeHandLoad(kHandLoad, message);
}

bool ForceInbox::OnSetHandLoad(kinescope_ros::SetHandLoad::Request& request,
                               kinescope_ros::SetHandLoad::Response& response) {
  response.message = TakeHandLoad(kSetHandLoad, request);
  response.success = response.message.empty();
  return true;
}

void ForceInbox::OnHandWrench(urdf::Side side, const geometry_msgs::WrenchStamped& message) {
  const char* const topic = kHandWrench[side];
  const auto frame = Place(topic, message.header);
  if (!frame) return;
  auto hand = ToHandForce(message, *frame, side, *body_);
  if (!hand) return Refuse(topic, hand.error());
  hand->stamp_nanos = StampOf(topic, message.header);
  measured_.hands[side] = *hand;
  has_news_ = true;
  Use(topic);
}

void ForceInbox::OnFootWrench(urdf::Side side, const geometry_msgs::WrenchStamped& message) {
  const char* const topic = kFootWrench[side];
  const auto frame = Place(topic, message.header);
  if (!frame) return;
  auto foot = ToGroundForce(message, *frame, *body_);
  if (!foot) return Refuse(topic, foot.error());
  foot->stamp_nanos = StampOf(topic, message.header);
  measured_.feet[side] = *foot;
  has_news_ = true;
  Use(topic);
}

void ForceInbox::OnGroundWrench(const geometry_msgs::WrenchStamped& message) {
  const auto frame = Place(kGroundWrench, message.header);
  if (!frame) return;
  auto ground = ToGroundForce(message, *frame, *body_);
  if (!ground) return Refuse(kGroundWrench, ground.error());
  ground->stamp_nanos = StampOf(kGroundWrench, message.header);
  ground_wrench_ = *ground;
  CombineGround();
  Use(kGroundWrench);
}

void ForceInbox::OnGroundCop(const geometry_msgs::PointStamped& message) {
  const auto frame = Place(kGroundCop, message.header);
  if (!frame) return;
  const auto cop = ToCop(message, *frame, *body_);
  if (!cop) return Refuse(kGroundCop, cop.error());
  ground_cop_ = *cop;
  ground_cop_nanos_ = StampOf(kGroundCop, message.header);
  CombineGround();
  Use(kGroundCop);
}

// A measured CoP is a more accurate point of action than the moments of a measured force. A CoP
// alone is used with the force that the motion requires.
void ForceInbox::CombineGround() {
  has_news_ = true;
  const bool has_cop = ground_cop_.has_value();
  if (ground_wrench_ && (!has_cop || ground_wrench_->stamp_nanos >= ground_cop_nanos_ ||
                         AreOfOneTime(ground_wrench_->stamp_nanos, ground_cop_nanos_))) {
    measured_.ground = ground_wrench_;
    const bool is_current = has_cop && AreOfOneTime(ground_wrench_->stamp_nanos, ground_cop_nanos_);
    if (is_current) measured_.ground->point = *ground_cop_;
    return;
  }
  MeasuredGroundForce ground;
  ground.only_point = true;
  ground.point = *ground_cop_;
  ground.stamp_nanos = ground_cop_nanos_;
  measured_.ground = ground;
}

void ForceInbox::UseExternal(const char* topic, const Taken<ExternalLoads>& loads,
                             std::int64_t stamp_nanos) {
  if (!loads) return Refuse(topic, loads.error());
  for (std::size_t joint = 0; joint < loads->joints.size(); ++joint) {
    if (!loads->is_given[joint]) continue;
    measured_.joints[joint] = loads->joints[joint];
    measured_.joints[joint].stamp_nanos = stamp_nanos;
  }
  has_news_ = true;
  Use(topic);
  if (loads->unknown_joints == 0) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_[topic].unknown_joints += static_cast<std::uint64_t>(loads->unknown_joints);
}

void ForceInbox::OnExternalLoads(const kinescope_ros::JointLoadArray& message) {
  const auto frame = Place(kExternalLoads, message.header);
  if (!frame) return;
  UseExternal(kExternalLoads, ToExternalLoads(message, *frame, settings_.external_scale),
              StampOf(kExternalLoads, message.header));
}

void ForceInbox::OnExternalJointStates(const sensor_msgs::JointState& message) {
  if (!body_) {
    return Refuse(kExternalJointStates, NoPersonYet());
  }
  UseExternal(kExternalJointStates, ToExternalLoads(message, *body_, settings_.external_scale),
              StampOf(kExternalJointStates, message.header));
}

void ForceInbox::OnUnreadable(const std::string& topic) { Refuse(topic, Unreadable()); }

bool ForceSubscriptions::AreComplete() const {
  for (const ros::Subscriber& subscriber : subscribers) {
    if (!subscriber) return false;
  }
  return static_cast<bool>(service);
}

ForceSubscriptions SubscribeForces(ros::NodeHandle& node, const std::string& prefix,
                                   ros::CallbackQueue& queue,
                                   const std::shared_ptr<ForceInbox>& inbox) {
  ForceSubscriptions all;
  const auto hear = [&](const std::string& name, auto take, auto message) {
    using Message = BoundedMessage<decltype(message)>;
    auto options = ros::SubscribeOptions::create<Message>(
        prefix + name, kForceQueue,
        [inbox, take, name](const boost::shared_ptr<const Message>& heard) {
          if (!heard->is_sound) return inbox->OnUnreadable(name);
          take(*inbox, heard->message);
        },
        ros::VoidConstPtr(), &queue);
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    all.subscribers.push_back(node.subscribe(options));
  };
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    hear(
        kHandWrench[side], [side](ForceInbox& in, const auto& m) { in.OnHandWrench(side, m); },
        geometry_msgs::WrenchStamped());
    hear(
        kFootWrench[side], [side](ForceInbox& in, const auto& m) { in.OnFootWrench(side, m); },
        geometry_msgs::WrenchStamped());
  }
  hear(
      kGroundWrench, [](ForceInbox& in, const auto& m) { in.OnGroundWrench(m); },
      geometry_msgs::WrenchStamped());
  hear(
      kGroundCop, [](ForceInbox& in, const auto& m) { in.OnGroundCop(m); },
      geometry_msgs::PointStamped());
  hear(
      kExternalLoads, [](ForceInbox& in, const auto& m) { in.OnExternalLoads(m); },
      kinescope_ros::JointLoadArray());
  hear(
      kExternalJointStates, [](ForceInbox& in, const auto& m) { in.OnExternalJointStates(m); },
      sensor_msgs::JointState());
  hear(
      kHandLoad, [](ForceInbox& in, const auto& m) { in.OnHandLoad(m); },
      kinescope_ros::HandLoad());
  using Service = kinescope_ros::SetHandLoad;
  using Request = BoundedMessage<Service::Request>;
  ros::AdvertiseServiceOptions service;
  service.init<Request, Service::Response>(
      prefix + kSetHandLoad, [inbox](Request& request, Service::Response& response) {
        return request.is_sound && inbox->OnSetHandLoad(request.message, response);
      });
  service.callback_queue = &queue;
  all.service = node.advertiseService(service);
  return all;
}

}  // namespace kinescope::ros_bridge
