#include "server/ros/source/bag_surroundings.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "server/ros/image_messages.h"
#include "server/ros/markers.h"
#include "server/ros/names.h"
#include "server/ros/raw_message.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::size_t kMostMarkerTopics = 256;
constexpr std::size_t kMostWarnings = 8;
constexpr std::int64_t kPlaceEveryNanos = 16'000'000;  // of the bag: robots, for any frame rate
constexpr char kUnreadableMarkers[] = "markers that are truncated or have a wrong length field";
constexpr char kUnreadableJoints[] = "joint states that are truncated or have a wrong length field";

bool IsOne(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<visualization_msgs::Marker>();
}

bool IsArray(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<visualization_msgs::MarkerArray>();
}

bool HasJoints(const BagConnection& connection) {
  return connection.md5sum == ros::message_traits::md5sum<sensor_msgs::JointState>();
}

std::map<std::string, ShownTopic> ByName(const std::vector<ShownTopic>& topics) {
  std::map<std::string, ShownTopic> all;
  for (const ShownTopic& topic : topics) {
    if (topic.is_frame) continue;
    const ShownTopic named{WithSlash(topic.name), topic.style};
    all.insert_or_assign(named.name, named);
    if (const std::string whole = TopicOfAll(named.name); !whole.empty()) all.emplace(whole, named);
  }
  return all;
}

bool IsWhole(const BagMessage& message) { return message.bytes.size() == message.size; }

}  // namespace

BagSurroundings::BagSurroundings(const GraphView& view)
    : shown_topics_(ByName(view.topics)), camera_frame_(view.camera_frame) {
  for (const ShownTopic& topic : view.topics) {
    if (!topic.is_frame) continue;
    if (topic.is_every_frame()) {
      frames_.emplace(topic.style, kPlaceEveryNanos);
      continue;
    }
    // A topic begins with a slash, this name does not.
    AddAxes(store_, topics_.try_emplace("tf:" + topic.name, topics_.size()).first->second, topic);
    has_markers_ = true;
  }
  for (const GraphRobot& robot : view.robots) {
    robots_.push_back({RobotFrames(robot.robot, robot.tf_prefix), JointStatesOf(robot)});
  }
}

bool BagSurroundings::IsUsed(const BagConnection& connection) const {
  if (IsOne(connection) || IsArray(connection)) return true;
  const std::string topic = WithSlash(connection.topic);
  if (HasJoints(connection)) {
    return std::any_of(robots_.begin(), robots_.end(),
                       [&](const Robot& robot) { return robot.joint_states == topic; });
  }
  return shown_topics_.count(topic) != 0 &&
         (IsImageType(connection.md5sum) || TopicMarkers::IsShown(connection.md5sum));
}

void BagSurroundings::Take(const BagMessage& message, SourceCounters& counters) {
  const BagConnection& connection = *message.connection;
  if (HasJoints(connection)) return TakeJointStates(message, counters);
  if (IsOne(connection) || IsArray(connection)) return TakeMarkers(message, counters);
  if (IsImageType(connection.md5sum)) return TakeImage(message, counters);
  TakeShown(message, counters);
}

// Into array_. Why it cannot be used, or null.
const char* BagSurroundings::Decode(const BagMessage& message) {
  if (!IsWhole(message)) return "markers of more than 16 MiB";
  if (IsArray(*message.connection)) {
    return kinescope::ros_bridge::Decode(message.bytes, array_) ? nullptr : kUnreadableMarkers;
  }
  if (!kinescope::ros_bridge::Decode(message.bytes, marker_)) return kUnreadableMarkers;
  array_.markers.assign(1, marker_);
  return nullptr;
}

std::optional<std::size_t> BagSurroundings::NumberOf(const std::string& topic,
                                                     SourceCounters& counters) {
  if (topics_.count(topic) == 0 && topics_.size() >= kMostMarkerTopics) {
    ++counters.ignored["markers of further topics"];
    return std::nullopt;
  }
  return topics_.try_emplace(topic, topics_.size()).first->second;
}

void BagSurroundings::TakeMarkers(const BagMessage& message, SourceCounters& counters) {
  if (const char* const defect = Decode(message)) {
    ++counters.rejected[defect];
    return;
  }
  if (!array_.markers.empty() && IsOwnMarkerNamespace(array_.markers.front().ns)) {
    ++counters.ignored["markers of Kinescope"];
    return;
  }
  const auto number = NumberOf(message.connection->topic, counters);
  if (!number) return;
  has_markers_ = true;
  const auto named = shown_topics_.find(WithSlash(message.connection->topic));
  const ShownStyle style = named == shown_topics_.end() ? ShownStyle() : named->second.style;
  const auto refused = store_.ApplyAll(*number, array_.markers, message.recorded_nanos, style);
  if (refused) ++counters.rejected[std::string("marker: ") + refused->kind];
}

void BagSurroundings::TakeShown(const BagMessage& message, SourceCounters& counters) {
  if (!IsWhole(message)) {
    ++counters.rejected["messages of more than 16 MiB"];
    return;
  }
  const ShownTopic& topic = shown_topics_.at(WithSlash(message.connection->topic));
  const auto number = NumberOf(topic.name, counters);
  if (!number) return;
  has_markers_ = true;
  ShownMarkers markers;
  const auto refused = shown_.Take(*number, topic.name, topic.style, message.connection->md5sum,
                                   message.bytes, markers);
  const auto undrawn = store_.ApplyAll(*number, markers, message.recorded_nanos, topic.style);
  if (refused || undrawn) {
    ++counters.rejected[message.connection->type + ": " + (refused ? refused : undrawn)->kind];
  }
}

void BagSurroundings::TakeImage(const BagMessage& message, SourceCounters& counters) {
  const BagConnection& connection = *message.connection;
  const auto refuse = [&](const char* kind) { ++counters.rejected[connection.type + ": " + kind]; };
  if (!IsWhole(message)) return refuse("more than 16 MiB");
  Taken<CameraImage> image = ReadImage(
      connection.md5sum, std::make_shared<const std::vector<std::uint8_t>>(message.bytes));
  if (!image) return refuse(image.error().kind);
  const auto number = NumberOf(connection.topic, counters);
  if (!number) return;
  image->name = NameOfCamera(WithSlash(connection.topic));
  if (const auto refusal = images_.Put(*number, *std::move(image))) refuse(refusal->kind);
}

void BagSurroundings::TakeJointStates(const BagMessage& message, SourceCounters& counters) {
  sensor_msgs::JointState joints;
  if (!IsWhole(message) || !ReadBounded(message.bytes.data(), message.bytes.size(), joints)) {
    ++counters.rejected[kUnreadableJoints];
    return;
  }
  const std::string topic = WithSlash(message.connection->topic);
  for (Robot& robot : robots_) {
    if (robot.joint_states == topic) robot.frames.Take(joints);
  }
}

void BagSurroundings::AddTransforms(const tf2_msgs::TFMessage& message, bool is_static) {
  const bool is_used =
      has_markers_ || !robots_.empty() || camera_frame_.is_wanted() || frames_ || is_static;
  if (is_used) tf_.Add(message, is_static);
}

bool BagSurroundings::PlaceRobots(std::int64_t now_nanos, const std::string& world) {
  if (placed_nanos_ && now_nanos >= *placed_nanos_ && now_nanos - *placed_nanos_ < kPlaceEveryNanos)
    return false;
  placed_nanos_ = now_nanos;
  bool has_moved = std::exchange(has_new_robots_, false) && !robots_.empty();
  for (Robot& robot : robots_) {
    const auto find = [&](const std::string& frame) -> std::optional<urdf::Pose> {
      if (frame == world) return urdf::Pose{};
      return tf_.Find(world, frame, 0);
    };
    has_moved = robot.frames.Place(find) || has_moved;
  }
  return has_moved;
}

void BagSurroundings::Update(std::int64_t now_nanos, const std::string& world,
                             const std::string& bag, SampleSink& sink) {
  if (world.empty()) return;
  const auto find = [&](const std::string& frame,
                        std::int64_t stamp_nanos) -> std::optional<urdf::Pose> {
    if (frame.empty() || frame == world) return urdf::Pose{};
    return tf_.Find(world, frame, stamp_nanos);
  };
  const bool has_moved = PlaceRobots(now_nanos, world);
  const bool has_new_markers = has_markers_ && store_.Update(now_nanos, find);
  const bool has_new_images = images_.TakeChanged();
  const auto find_now = [&find](const std::string& frame) { return find(frame, 0); };
  const bool has_new_base = camera_frame_.Update(now_nanos, find_now);
  const auto list = [&] {
    std::vector<TreeFrame> frames = tf_.frames();
    frames.push_back({world, "", 0});
    return frames;
  };
  const bool has_new_frames = frames_ && frames_->Update(now_nanos, list, find_now);
  if (has_moved || has_new_markers || has_new_images || has_new_base || has_new_frames) {
    RecordedSurroundings all{
        Together(store_.markers(), frames_), {}, images_.images(), camera_frame_.pose()};
    for (const Robot& robot : robots_) all.robots.push_back(robot.frames.now());
    sink.OnSurroundings(all);
  }
  for (const MarkerStore::Lost& lost : store_.TakeLost()) {
    if (lost_frames_.size() >= kMostWarnings || !lost_frames_.insert(lost.text).second) continue;
    spdlog::warn("bag '{}': {}; it is not shown", bag, lost.text);
  }
  if (!frames_) return;
  const std::string lost = frames_->TakeLost();
  if (!lost.empty()) spdlog::warn("bag '{}': {}", bag, lost);
}

void BagSurroundings::WarnOfProblems(const std::string& bag) const {
  static std::mutex mutex;
  static std::set<std::string> told;  // guarded by mutex
  for (const Robot& robot : robots_) {
    const std::string& problem = robot.frames.now()->problem;
    if (problem.empty()) continue;
    const std::string line = fmt::format("bag '{}': {}", bag, problem);
    const std::lock_guard<std::mutex> lock(mutex);
    if (told.insert(line).second) spdlog::warn("{}", line);
  }
}

}  // namespace kinescope::ros_bridge
