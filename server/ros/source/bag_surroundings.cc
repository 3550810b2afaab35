#include "server/ros/source/bag_surroundings.h"

#include <ros/message_traits.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "server/ros/calibration.h"
#include "server/ros/image_messages.h"
#include "server/ros/markers.h"
#include "server/ros/names.h"
#include "server/ros/raw_message.h"
#include "server/ros/shown_messages.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::size_t kMostMarkerTopics = 256;
constexpr std::size_t kMostWarnings = 8;
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

std::vector<ShownTopic> WithSlashes(const std::vector<ShownTopic>& topics) {
  std::vector<ShownTopic> all;
  for (const ShownTopic& topic : topics) {
    if (topic.is_frame || topic.leaves_out_others) continue;
    all.push_back({WithSlash(topic.name), topic.style});
    std::string& colors = all.back().style.camera.color_topic;
    if (!colors.empty()) colors = WithSlash(colors);
  }
  return all;
}

bool IsWhole(const BagMessage& message) { return message.bytes.size() == message.size; }

Refusal TooLong(const BagMessage& message) {
  return {"more than 64 MiB",
          fmt::format("a message of {} MB; at most 64 MiB are read", message.size / 1'000'000)};
}

}  // namespace

BagSurroundings::BagSurroundings(const GraphView& view)
    : shown_topics_(WithSlashes(view.topics)), camera_frame_(view.camera_frame) {
  for (std::size_t i = 0; i < shown_topics_.size(); ++i) {
    topics_.try_emplace(SenderOf(i), topics_.size());  // drawn in this order, as of a live graph
    for (const HeardTopic& heard : TopicsHeardFor(shown_topics_[i])) {
      heard_.emplace(heard.name, Heard{i, heard.has_colors});
    }
  }
  for (const ShownTopic& topic : view.topics) {
    leaves_out_others_ = leaves_out_others_ || topic.leaves_out_others;
    if (!topic.is_frame) continue;
    shows_frames_ = shows_frames_ || !topic.is_grid;
    if (topic.is_every_frame()) {
      frames_.emplace_back(topic.style, kPlaceEveryNanos, static_cast<int>(frames_.size()));
      continue;
    }
    // A topic begins with a slash, this name does not.
    const std::string name = fmt::format("{}:{}", topics_.size(), topic.name);
    store_.AddOfFrame(topics_.try_emplace(name, topics_.size()).first->second, topic);
    has_markers_ = true;
  }
  for (const GraphRobot& robot : view.robots) {
    robots_.push_back({RobotFrames(robot.robot, robot.tf_prefix), JointStatesOf(robot)});
    joints_.Add(robot.robot.model, robot.tf_prefix);
  }
}

bool BagSurroundings::CanBeShown(const BagConnection& connection) {
  const std::string& type = connection.md5sum;
  return IsImageType(type) || (TopicMarkers::IsShown(type, {}) && !HasJoints(connection));
}

bool BagSurroundings::IsUsed(const BagConnection& connection) const {
  const std::string topic = WithSlash(connection.topic);
  if (IsOne(connection) || IsArray(connection)) {
    return !leaves_out_others_ || heard_.count(topic) != 0;
  }
  if (HasJoints(connection) && std::any_of(robots_.begin(), robots_.end(), [&](const Robot& robot) {
        return robot.joint_states == topic;
      })) {
    return true;
  }
  const std::string& type = connection.md5sum;
  const auto [first, last] = heard_.equal_range(topic);
  return std::any_of(first, last, [&](const auto& heard) {
    return IsImageType(type) || IsCalibrationType(type) ||
           TopicMarkers::IsShown(type, shown_topics_[heard.second.shown].style);
  });
}

void BagSurroundings::Take(const BagMessage& message, SourceCounters& counters) {
  const BagConnection& connection = *message.connection;
  heard_topics_.insert(WithSlash(connection.topic));
  if (HasJoints(connection)) TakeJointStates(message, counters);
  if (IsOne(connection) || IsArray(connection)) return TakeMarkers(message, counters);
  const std::string& type = connection.md5sum;
  const auto [first, last] = heard_.equal_range(WithSlash(connection.topic));
  for (auto each = first; each != last; ++each) {
    const auto& [shown, has_colors] = each->second;
    const ShownTopic& topic = shown_topics_[shown];
    const auto number = NumberOf(shown, counters);
    if (!number) continue;
    if (has_colors) {
      TakeColors(*number, message, counters);
    } else if (TopicMarkers::IsShown(type, topic.style)) {
      TakeShown(topic, *number, message, counters);
    } else if (IsCalibrationType(type)) {
      TakeCalibration(*number, message, counters);
    } else if (IsImageType(type)) {
      TakeImage(topic, *number, message, counters);
    }
  }
}

// Into array_. Why it cannot be used, or null.
const char* BagSurroundings::Decode(const BagMessage& message) {
  if (!IsWhole(message)) return "markers of more than 64 MiB";
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

std::optional<std::size_t> BagSurroundings::NumberOf(std::size_t shown, SourceCounters& counters) {
  return NumberOf(SenderOf(shown), counters);
}

std::string BagSurroundings::SenderOf(std::size_t shown) const {
  const std::string& name = shown_topics_[shown].name;
  const auto first = std::find_if(shown_topics_.begin(), shown_topics_.end(),
                                  [&](const ShownTopic& topic) { return topic.name == name; });
  const auto place = static_cast<std::size_t>(first - shown_topics_.begin());
  return place == shown ? name : name + " " + std::to_string(shown);
}

void BagSurroundings::TakeMarkers(const BagMessage& message, SourceCounters& counters) {
  if (const char* const defect = Decode(message)) {
    ++counters.rejected[defect];
    return;
  }
  const std::string name = WithSlash(message.connection->topic);
  if (!array_.markers.empty() && IsOwnMarker(name, array_.markers.front().ns)) {
    ++counters.ignored[kOwnMarkers];
    return;
  }
  has_markers_ = true;
  const auto apply = [&](const std::optional<std::size_t>& number, const ShownStyle& style) {
    if (!number) return;
    const auto refused = store_.ApplyAll(*number, array_.markers, message.recorded_nanos, style);
    if (refused) Reject(message, *refused, counters);
  };
  const auto [first, last] = heard_.equal_range(name);
  if (first == last) return apply(NumberOf(message.connection->topic, counters), {});
  for (auto each = first; each != last; ++each) {
    const std::size_t shown = each->second.shown;
    apply(NumberOf(shown, counters), shown_topics_[shown].style);
  }
}

void BagSurroundings::Reject(const BagMessage& message, const Refusal& refusal,
                             SourceCounters& counters) {
  const std::string defect = message.connection->type + ": " + refusal.kind;
  ++counters.rejected[defect];
  named_.insert(defect);
  Note(refusal.is_partial ? WithSlash(message.connection->topic) : LackOf(message), refusal);
}

std::string BagSurroundings::LackOf(const BagMessage& message) {
  return WithSlash(message.connection->topic) + ": not shown";
}

void BagSurroundings::Note(const std::string& what, const Refusal& refusal) {
  if (rejected_.size() >= kMostWarnings) return;
  rejected_.try_emplace(what + refusal.kind, what + ": " + refusal.text);
}

void BagSurroundings::TakeShown(const ShownTopic& topic, std::size_t number,
                                const BagMessage& message, SourceCounters& counters) {
  if (!IsWhole(message)) return Reject(message, TooLong(message), counters);
  has_markers_ = true;
  ShownMarkers markers;
  const auto refused = shown_.Take(number, topic.name, topic.style, message.connection->md5sum,
                                   message.bytes, markers);
  const auto undrawn =
      store_.ApplyAll(number, markers, message.recorded_nanos, topic.style,
                      TopicMarkers::LookOf(message.connection->md5sum, topic.style));
  if (refused && refused->may_come) lacks_.insert(LackOf(message));
  if (refused || undrawn) return Reject(message, refused ? *refused : *undrawn, counters);
  if (!markers.empty() && !lacks_.empty()) ForgetLack(LackOf(message));
}

// What had not come yet at the beginning is no news any more.
void BagSurroundings::ForgetLack(const std::string& key) {
  if (lacks_.erase(key) == 0) return;
  const auto begin = rejected_.lower_bound(key);
  const auto end = std::find_if(begin, rejected_.end(),
                                [&](const auto& each) { return !StartsWith(each.first, key); });
  rejected_.erase(begin, end);
}

void BagSurroundings::TakeImage(const ShownTopic& topic, std::size_t number,
                                const BagMessage& message, SourceCounters& counters) {
  const BagConnection& connection = *message.connection;
  if (!IsWhole(message)) return Reject(message, TooLong(message), counters);
  Taken<CameraImage> image = ReadImage(
      connection.md5sum, std::make_shared<const std::vector<std::uint8_t>>(message.bytes));
  if (!image) return Reject(message, image.error(), counters);
  image->name = NameOfCamera(topic.name);
  const CameraStyle& style = topic.style.camera;
  has_scenes_on_images_ = has_scenes_on_images_ || style.scene_opacity > 0;
  const auto refusal = images_.Put(number, *std::move(image), style);
  if (refusal) Reject(message, *refusal, counters);
}

void BagSurroundings::TakeCalibration(std::size_t number, const BagMessage& message,
                                      SourceCounters& counters) {
  if (!IsWhole(message)) return Reject(message, TooLong(message), counters);
  const Taken<Calibration> calibration = ReadCalibration(message.bytes);
  if (!calibration) return Reject(message, calibration.error(), counters);
  images_.PutCalibration(number, *calibration);
}

void BagSurroundings::TakeColors(std::size_t number, const BagMessage& message,
                                 SourceCounters& counters) {
  const BagConnection& connection = *message.connection;
  const auto refusal = IsWhole(message)
                           ? shown_.TakeColors(number, connection.md5sum, message.bytes)
                           : std::optional<Refusal>(TooLong(message));
  if (refusal) Reject(message, *refusal, counters);
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

void BagSurroundings::AddTransforms(const tf2_msgs::TFMessage& message, const std::string& topic,
                                    bool is_static) {
  const bool is_used = has_markers_ || has_scenes_on_images_ || !robots_.empty() ||
                       camera_frame_.is_wanted() || !frames_.empty() || is_static;
  if (!is_used) return;
  for (const Refusal& refusal : tf_.Add(message, is_static)) Note(WithSlash(topic), refusal);
}

std::vector<const RobotFrames*> BagSurroundings::Frames() const {
  std::vector<const RobotFrames*> all;
  all.reserve(robots_.size());
  for (const Robot& robot : robots_) all.push_back(&robot.frames);
  return all;
}

bool BagSurroundings::PlaceRobots(std::int64_t now_nanos, const std::string& world) {
  if (placed_nanos_ && now_nanos >= *placed_nanos_ && now_nanos - *placed_nanos_ < kPlaceEveryNanos)
    return false;
  placed_nanos_ = now_nanos;
  bool has_moved = std::exchange(has_new_robots_, false) && !robots_.empty();
  for (Robot& robot : robots_) {
    const auto find = [&](const std::string& frame) -> std::optional<urdf::Pose> {
      if (frame == world) return urdf::Pose{};
      return PoseOf(tf_.Find(world, frame, 0));
    };
    has_moved = robot.frames.Place(find) || has_moved;
  }
  return has_moved;
}

void BagSurroundings::Update(std::int64_t now_nanos, const std::string& world,
                             const std::string& bag, SampleSink& sink) {
  if (world.empty()) return;
  const auto find = [&](const std::string& frame,
                        std::int64_t stamp_nanos) -> std::optional<FramePlace> {
    if (frame.empty() || frame == world) return FramePlace{};
    if (auto found = tf_.Find(world, frame, stamp_nanos)) return found;
    const auto chained = FindChainedOf(Frames(), frame);
    return chained ? std::make_optional(FramePlace{*chained}) : std::nullopt;
  };
  const bool has_moved = PlaceRobots(now_nanos, world);
  const bool has_new_markers = has_markers_ && store_.Update(now_nanos, find);
  images_.Update(now_nanos, find);
  const bool has_new_images = images_.TakeChanged();
  const auto find_now = [&find](const std::string& frame) { return PoseOf(find(frame, 0)); };
  const bool has_new_base = camera_frame_.Update(now_nanos, find_now);
  const auto list = [&](const ShownFrames::TakeFrame& take) {
    for (const auto& [name, frame] : tf_.frames()) take(frame);
    if (tf_.frames().count(world) == 0) take({world, "", 0});
  };
  bool has_new_frames = false;
  for (ShownFrames& frames : frames_) {
    has_new_frames = frames.Update(now_nanos, list, find_now) || has_new_frames;
  }
  if (has_moved || has_new_markers || has_new_images || has_new_base || has_new_frames) {
    RecordedSurroundings all{
        Together(store_.markers(), frames_), {}, images_.images(), camera_frame_.pose()};
    for (const Robot& robot : robots_) all.robots.push_back(robot.frames.now());
    sink.OnSurroundings(all);
  }
  const auto warn = [&](const std::string& text) {
    if (lost_frames_.size() >= kMostWarnings || !lost_frames_.insert(text).second) return;
    spdlog::warn("bag '{}': {}", bag, text);
  };
  for (const WithoutPlace& lost : images_.TakeLost()) warn(lost.Text(tf_, world));
  if (frames_.empty()) return;
  const std::string lost = frames_.front().TakeLost();
  if (!lost.empty()) spdlog::warn("bag '{}': {}", bag, lost);
}

void WarnOfBag(const std::string& bag, const std::string& text) {
  static std::mutex mutex;
  static std::set<std::string> told;  // guarded by mutex
  const std::string line = fmt::format("bag '{}': {}", bag, PrintableLine(text));
  const std::lock_guard<std::mutex> lock(mutex);
  if (told.insert(line).second) spdlog::warn("{}", line);
}

void BagSurroundings::WarnOfProblems(const std::string& bag, const std::string& world) const {
  const auto warn = [&](const std::string& text) { WarnOfBag(bag, text); };
  for (const Robot& robot : robots_) {
    const std::string& problem = robot.frames.now()->problem;
    if (problem.empty()) continue;
    warn(fmt::format("{} ({})", problem, WhyNotFound(tf_, robot.frames.FirstMissing(), world)));
  }
  for (const auto& [kind, text] : rejected_) warn(text);
  std::size_t count = 0;
  for (const WithoutPlace& lost : store_.Unplaced()) {
    if (++count <= kMostWarnings) warn(lost.Text(tf_, world));
  }
  std::set<std::string> silent;
  for (const ShownTopic& topic : shown_topics_) {
    if (heard_topics_.count(topic.name) == 0) silent.insert(topic.name);
  }
  if (silent.empty()) return;
  warn(fmt::format("no message that can be shown up to here on {}", fmt::join(silent, ", ")));
}

}  // namespace kinescope::ros_bridge
