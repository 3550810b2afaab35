#include "server/ros/robot_inbox.h"

#include <ros/names.h>
#include <ros/subscribe_options.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <utility>

#include "core/system/clocks.h"
#include "core/system/words.h"
#include "server/download/robot_meshes.h"
#include "server/ros/raw_message.h"
#include "urdf/human_urdf.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::int64_t kWarningDelayNanos =
    5'000'000'000;  // before a missing frame is worth a warning
constexpr std::uint32_t kJointStateQueue = 100;

}  // namespace

RobotInbox::RobotInbox(std::vector<GraphRobot> wanted, std::shared_ptr<const SceneFrame> frame,
                       std::shared_ptr<const TfTree> tf)
    : wanted_(std::move(wanted)),
      frame_(std::move(frame)),
      tf_(std::move(tf)),
      slots_(wanted_.size()),
      texts_(wanted_.size()) {
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    counters_[NameOf(i)];  // shown even before it is there
    if (wanted_[i].parameter.empty()) loaded_[i] = wanted_[i].robot;
  }
}

std::string RobotInbox::ParameterOf(std::size_t i) const {
  const std::string& name = wanted_[i].parameter;
  return name.empty() ? name : ros::names::resolve(name);
}

std::string RobotInbox::JointStatesOf(std::size_t i) const {
  const std::string parameter = ParameterOf(i);
  if (parameter.empty()) return ros_bridge::JointStatesOf(wanted_[i]);
  return ros::names::append(ros::names::parentNamespace(parameter), "joint_states");
}

std::string RobotInbox::NameOf(std::size_t i) const {
  const std::string parameter = ParameterOf(i);
  return "robot " + (parameter.empty() ? wanted_[i].robot.name : parameter);
}

void RobotInbox::Refuse(std::size_t i, const Refusal& refusal) {
  const std::lock_guard<std::mutex> lock(mutex_);
  CountRefused(refusal, counters_[NameOf(i)]);
}

void RobotInbox::SetDescription(std::size_t i, const std::optional<std::string>& urdf) {
  if (!urdf) WarnOfMissing(i);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (texts_[i] == urdf) return;
    texts_[i] = urdf;
  }
  if (!urdf) return;  // what is shown stays, as in RViz
  if (urdf::IsWrittenByKinescope(*urdf)) {
    spdlog::info("{} is a person of Kinescope, who is shown as one{}", ParameterOf(i),
                 wanted_[i].opacity < 1 ? "; --body_opacity makes people translucent" : "");
    return Refuse(i, {"of Kinescope", "a person of Kinescope: the scene has them already"});
  }
  RobotState robot;
  try {
    robot.model = std::make_shared<const urdf::RobotModel>(
        urdf::Translucent(urdf::ParseUrdf(*urdf), wanted_[i].opacity));
  } catch (const urdf::UrdfError& error) {
    spdlog::warn("{}: {}; the robot is not shown", ParameterOf(i), error.what());
    return Refuse(i, {"not a URDF", error.what()});
  }
  robot.name = robot.model->name;
  urdf::MeshSearch search = urdf::MakeMeshSearch("", {});
  search.urdf_folder.clear();  // the URDF is in no folder
  robot.meshes = std::make_shared<const urdf::MeshSearch>(std::move(search));
  spdlog::info("{}: robot '{}' with {} links", ParameterOf(i), robot.name,
               robot.model->links.size());
  for (const std::string& note : robot.model->notes) {
    spdlog::warn("robot '{}': {}", robot.name, note);
  }
  const std::size_t remote = download::CountRemoteMeshes(*robot.model);
  if (remote == 0) return TakeUp(i, std::move(robot));
  spdlog::info("robot '{}': loads {} from web servers", robot.name,
               Counted(remote, "mesh", "meshes"));
  if (loader_ == nullptr) {
    loader_ = std::make_unique<RobotLoader>([this](std::size_t loaded, RobotState with_meshes) {
      TakeUp(loaded, std::move(with_meshes));
    });
  }
  loader_->Load(i, std::move(robot));
}

void RobotInbox::WarnOfMissing(std::size_t i) {
  const std::int64_t now = MonotonicNanos();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    InputCounters& counters = counters_[NameOf(i)];
    if (counters.received > 0 || !counters.last_problem.empty()) return;
    const auto [missed, is_new] = missed_.try_emplace(i, now);
    if (is_new || now - missed->second < kWarningDelayNanos) return;
    counters.last_problem = "the parameter is not set";
  }
  spdlog::warn("{}: the parameter is not set; the robot is shown as soon as it is", ParameterOf(i));
}

void RobotInbox::TakeUp(std::size_t i, RobotState robot) {
  const std::lock_guard<std::mutex> lock(mutex_);
  loaded_[i] = std::move(robot);
  InputCounters& counters = counters_[NameOf(i)];
  ++counters.received;
  ++counters.used;
  counters.last_problem.clear();
}

void RobotInbox::SetProblem(std::size_t i, const std::string& why) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (counters_[NameOf(i)].last_problem == why) return;
  }
  spdlog::warn("{}: {}; the robot is not shown", ParameterOf(i), why);
  Refuse(i, {"cannot be read", why});
}

void RobotInbox::OnJointStates(std::size_t i, const sensor_msgs::JointState& message) {
  if (slots_[i].frames) slots_[i].frames->Take(message);
}

void RobotInbox::Deliver(std::int64_t monotonic_nanos, std::int64_t stamp_nanos, InputSink& sink) {
  if (monotonic_nanos - placed_nanos_ < kPlaceEveryNanos) return;
  placed_nanos_ = monotonic_nanos;
  std::map<std::size_t, RobotState> loaded;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    loaded.swap(loaded_);
  }
  for (auto& [i, robot] : loaded) {
    slots_[i].frames.emplace(std::move(robot), wanted_[i].tf_prefix);
    has_news_ = true;
  }
  if (!loaded.empty()) ListJoints();
  RobotList robots;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].frames) continue;
    RobotFrames& frames = *slots_[i].frames;
    const auto find = [&](const std::string& frame) -> std::optional<urdf::Pose> {
      if (frame == frame_->name()) return urdf::Pose{};
      return PoseOf(tf_->Find(frame_->name(), frame, stamp_nanos));
    };
    if (frames.Place(find)) has_news_ = true;
    Warn(i, monotonic_nanos);
    robots.push_back(frames.now());
  }
  if (!std::exchange(has_news_, false)) return;
  sink.OnRobots(robots);
}

void RobotInbox::ListJoints() {
  ShownJoints joints;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i].frames) joints.Add(slots_[i].frames->now()->model, wanted_[i].tf_prefix);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  joints_ = std::move(joints);
}

std::optional<ShownJoint> RobotInbox::FindJoint(const std::string& name) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return joints_.Find(name);
}

std::vector<const RobotFrames*> RobotInbox::Frames() const {
  std::vector<const RobotFrames*> all;
  for (const Slot& slot : slots_) {
    if (slot.frames) all.push_back(&*slot.frames);
  }
  return all;
}

// Frames come one after another when a robot is started: only what stays away is worth a word.
void RobotInbox::Warn(std::size_t i, std::int64_t monotonic_nanos) {
  Slot& slot = slots_[i];
  const std::string& problem = slot.frames->now()->problem;
  if (problem.empty()) {
    slot.incomplete_nanos = 0;
    if (std::exchange(slot.warned_of, "").empty()) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    counters_[NameOf(i)].last_problem.clear();
    not_shown_.erase(i);
    return;
  }
  if (slot.incomplete_nanos == 0) slot.incomplete_nanos = monotonic_nanos;
  if (monotonic_nanos - slot.incomplete_nanos < kWarningDelayNanos) return;
  const std::string& frame = frame_->name();
  const std::string text = fmt::format("{}: {} ({})", NameOf(i), problem,
                                       WhyNotFound(*tf_, slot.frames->FirstMissing(), frame));
  if (std::exchange(slot.warned_of, text) == text) return;
  spdlog::warn("{}; does robot_state_publisher run, and is '{}' connected to it in TF?", text,
               frame);
  const std::lock_guard<std::mutex> lock(mutex_);
  counters_[NameOf(i)].last_problem = problem;
  not_shown_[i] = text;
}

std::vector<std::string> RobotInbox::not_shown() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<std::string> all;
  all.reserve(not_shown_.size());
  for (const auto& [i, text] : not_shown_) all.push_back(text);
  return all;
}

std::map<std::string, InputCounters> RobotInbox::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

std::vector<ros::Subscriber> SubscribeJointStates(ros::NodeHandle& node, ros::CallbackQueue& queue,
                                                  const std::shared_ptr<RobotInbox>& inbox) {
  using Heard = BoundedMessage<sensor_msgs::JointState>;
  std::vector<ros::Subscriber> all;
  for (std::size_t i = 0; i < inbox->size(); ++i) {
    auto options = ros::SubscribeOptions::create<Heard>(
        inbox->JointStatesOf(i), kJointStateQueue,
        [inbox, i](const boost::shared_ptr<const Heard>& heard) {
          if (heard->is_sound) inbox->OnJointStates(i, heard->message);
        },
        ros::VoidConstPtr(), &queue);
    all.push_back(node.subscribe(options));
  }
  return all;
}

}  // namespace kinescope::ros_bridge
