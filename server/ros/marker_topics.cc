#include "server/ros/marker_topics.h"

#include <ros/names.h>
#include <ros/subscribe_options.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/utf8.h"
#include "server/ros/markers.h"
#include "urdf/segments.h"

namespace kinescope::ros_bridge {
namespace {

// Each message may be the only one of its marker, so none should be lost while a sample is
// processed.
constexpr std::uint32_t kMarkerQueue = 1000;
constexpr std::size_t kMostWaiting = 2 * kMaxPointsOfAll;  // points

// The page has new markers ten times a second, and the history keeps each list of them.
constexpr std::int64_t kFramesEveryNanos = 50'000'000;

std::vector<ShownTopic> Resolved(std::vector<ShownTopic> topics) {
  for (ShownTopic& topic : topics) {
    if (topic.is_frame) continue;
    std::string why;
    if (topic.name.empty() || !ros::names::validate(topic.name, why)) {
      throw UsageError(
          fmt::format("--marker_topics: invalid topic name '{}'; expected names such as "
                      "/walls,/plan/markers",
                      topic.name));
    }
    topic.name = ros::names::resolve(topic.name);
    std::string& colors = topic.style.camera.color_topic;
    if (!colors.empty()) colors = ros::names::resolve(colors);
  }
  if (topics.size() > kMostShownTopics) {
    throw UsageError(fmt::format("--marker_topics: {} topics; expected at most {}", topics.size(),
                                 kMostShownTopics));
  }
  return topics;
}

// About as its memory: a marker is worth ten points.
std::size_t WeightOf(const DecodedMessage& message) {
  constexpr std::size_t kOfMarker = 10;
  std::size_t weight = kOfMarker;
  for (const visualization_msgs::Marker& marker : message.markers) {
    weight += kOfMarker + marker.points.size();
  }
  return weight;
}

}  // namespace

MarkerInbox::MarkerInbox(std::vector<ShownTopic> topics, CameraFrames camera_frame,
                         std::shared_ptr<const SceneFrame> frame, std::shared_ptr<const TfTree> tf,
                         std::shared_ptr<const RobotInbox> robots)
    : topics_(Resolved(std::move(topics))),
      frame_(std::move(frame)),
      placed_in_(frame_->name()),
      tf_(std::move(tf)),
      robots_(std::move(robots)),
      decoder_(topics_,
               [this](const std::string& joint) {
                 return robots_ ? robots_->FindJoint(joint) : std::nullopt;
               }),
      camera_frame_(std::move(camera_frame)) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const ShownTopic& topic = topics_[i];
    if (topic.is_every_frame()) {
      frames_.emplace_back(topic.style, kFramesEveryNanos, static_cast<int>(frames_.size()));
    } else if (topic.is_frame) {
      store_.AddOfFrame(i, topic);
    } else {
      counters_[topic.name];  // shown even without messages
    }
  }
}

void MarkerInbox::OnMessage(std::size_t topic, const MarkerDecoder::Event& event, bool has_colors,
                            std::int64_t monotonic_nanos) {
  decoder_.OnMessage(topic, event, has_colors, monotonic_nanos);
  PassOn();
}

void MarkerInbox::FinishMessages() {
  decoder_.DecodeKept(MonotonicNanos());
  PassOn();
}

void MarkerInbox::Erase(const std::string& name) {
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (topics_[i].name != name || topics_[i].is_frame) continue;
    DecodedMessage end{i, MonotonicNanos()};
    end.markers.emplace_back();
    end.markers.back().action = visualization_msgs::Marker::DELETEALL;
    end.is_end = true;
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_ += WeightOf(end);
    decoded_.push_back(std::move(end));
  }
}

// What waits is limited: the thread that reads samples may be slower than this one.
void MarkerInbox::PassOn() {
  for (DecodedMessage& message : decoder_.Take()) {
    const std::size_t weight = WeightOf(message);
    std::unique_lock<std::mutex> lock(mutex_);
    if (waiting_ > 0 && waiting_ + weight > kMostWaiting) {
      lock.unlock();
      Refuse(message.topic, {"too fast", "messages come faster than they can be shown"});
      continue;
    }
    waiting_ += weight;
    decoded_.push_back(std::move(message));
  }
}

// Samples wait meanwhile, so the rest may have to.
void MarkerInbox::TakeDecoded(std::int64_t graph_nanos) {
  constexpr std::int64_t kMostNanos = 2'000'000;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::move(decoded_.begin(), decoded_.end(), std::back_inserter(taken_));
    decoded_.clear();
  }
  const std::int64_t began = MonotonicNanos();
  while (!taken_.empty() && MonotonicNanos() - began < kMostNanos) {
    const std::size_t weight = WeightOf(taken_.front());
    Take(taken_.front(), graph_nanos);
    taken_.pop_front();
    const std::lock_guard<std::mutex> lock(mutex_);
    waiting_ -= weight;
  }
}

void MarkerInbox::Take(DecodedMessage& message, std::int64_t graph_nanos) {
  const std::size_t topic = message.topic;
  const Now came(message.monotonic_nanos, graph_nanos);
  if (message.has_single_markers) {
    for (const auto& marker : message.markers) Take(topic, marker, came);
    return;
  }
  const auto undrawn =
      store_.ApplyAll(topic, message.markers, came, topics_[topic].style, message.look);
  if (message.is_end) return;
  if (message.refusal) return Refuse(topic, *message.refusal);
  if (undrawn) return Refuse(topic, *undrawn);
  if (message.calibration) return images_.PutCalibration(topic, *message.calibration);
  if (message.image) return TakeImage(topic, *std::move(message.image));
  CountUsed(topic);
}

void MarkerInbox::TakeImage(std::size_t topic, CameraImage image) {
  const CameraStyle& style = topics_[topic].style.camera;
  if (const auto refusal = images_.Put(topic, std::move(image), style)) {
    return Refuse(topic, *refusal);
  }
  CountUsed(topic);
}

void MarkerInbox::CountUsed(std::size_t topic) {
  const std::lock_guard<std::mutex> lock(mutex_);
  InputCounters& counters = counters_[topics_[topic].name];
  ++counters.received;
  ++counters.used;
}

void MarkerInbox::Take(std::size_t topic, const visualization_msgs::Marker& message,
                       const Now& now) {
  if (IsOwnMarker(topics_[topic].name, message.ns)) {
    return Refuse(topic, {"of Kinescope", "markers of Kinescope: the scene has them already",
                          /*is_in_log=*/false});
  }
  if (const auto refusal = store_.Apply(topic, message, now, topics_[topic].style)) {
    return Refuse(topic, *refusal);
  }
  CountUsed(topic);
}

// Each kind is worth a line in the log once.
void MarkerInbox::Refuse(std::size_t topic, const Refusal& refusal) {
  bool is_first = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_first = CountRefused(refusal, counters_[topics_[topic].name]);
  }
  if (is_first) WarnOfRefused(topics_[topic].name, refusal);
}

// A frame may come a little later than what stands in it.
void MarkerInbox::WarnOfUnplaced(std::int64_t monotonic_nanos) {
  constexpr std::int64_t kEveryNanos = 5'000'000'000;
  constexpr std::size_t kMostOfTopic = 3, kMostWarnings = 60;
  if (monotonic_nanos - looked_nanos_ < kEveryNanos) return;
  looked_nanos_ = monotonic_nanos;
  std::set<std::string> unplaced;
  std::map<std::size_t, std::size_t> counts;  // by topic: one must not hide the others
  std::vector<std::string> not_shown;
  for (const WithoutPlace& lost : store_.Unplaced()) {
    std::string text = PrintableLine(topics_[lost.topic].name + ": " + TextOf(lost));
    const bool is_for_long = unplaced_.count(text) > 0;
    unplaced.insert(text);
    if (!is_for_long || ++counts[lost.topic] > kMostOfTopic) continue;
    if (warned_.size() < kMostWarnings && warned_.insert(text).second) spdlog::warn("{}", text);
    TellOfOtherTree(lost.frame);
    not_shown.push_back(std::move(text));
  }
  for (const auto& [topic, count] : counts) {
    if (count <= kMostOfTopic) continue;
    const std::string& name = topics_[topic].name;
    not_shown.push_back(
        fmt::format("{}: markers in {} more frames without a place", name, count - kMostOfTopic));
    if (warned_.size() < kMostWarnings && warned_.insert(name).second) {
      spdlog::warn("{} (ros.not_shown of /api/v1/diagnostics counts them)", not_shown.back());
    }
  }
  unplaced_ = std::move(unplaced);
  const std::lock_guard<std::mutex> lock(mutex_);
  not_shown_ = std::move(not_shown);
}

// Once: a robot whose frames have nothing to do with those of the person has many topics.
void MarkerInbox::TellOfOtherTree(const std::string& frame) {
  if (has_told_of_trees_ || frame.empty()) return;
  const std::string root = PrintableLine(OtherTreeOf(*tf_, frame, frame_->name()));
  if (root.empty()) return;
  has_told_of_trees_ = true;
  spdlog::warn(
      "what hangs on '{}' in TF is shown once a transform connects it with '{}', in which the "
      "scene stands: let a node publish one, such as static_transform_publisher of tf2_ros, or "
      "start with --reference_frame {}, and people stand in '{}'",
      root, frame_->name(), root, root);
}

std::vector<std::string> MarkerInbox::not_shown() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return not_shown_;
}

void MarkerInbox::SetPerson(const PersonState& person, double floor_z) {
  Body& body = bodies_[person.character];
  body.model = person.model->human.model_name;
  body.now = {person.links, person.model->human.skeleton, floor_z, person.sample.stamp_nanos};
}

std::optional<FramePlace> MarkerInbox::Find(const std::string& frame,
                                            std::int64_t stamp_nanos) const {
  // An empty frame means that of the scene.
  const std::string& reference_frame = frame_->name();
  if (frame.empty() || frame == reference_frame) return FramePlace{};
  for (const auto& [character, body] : bodies_) {
    const auto found = FindFrame(frame, stamp_nanos, reference_frame, body.model, body.now, *tf_);
    if (found) return FramePlace{found->pose, found->is_early};
  }
  if (bodies_.empty()) {
    if (auto found = tf_->Find(reference_frame, frame, stamp_nanos)) return found;
  }
  const auto chained = FindChainedOf(Robots(), frame);
  return chained ? std::make_optional(FramePlace{*chained}) : std::nullopt;
}

std::vector<const RobotFrames*> MarkerInbox::Robots() const {
  return robots_ ? robots_->Frames() : std::vector<const RobotFrames*>();
}

bool MarkerInbox::UpdateFrames(const Now& now) {
  if (frames_.empty()) return false;
  const auto list = [this](const ShownFrames::TakeFrame& take) {
    for (const auto& [name, frame] : tf_->frames()) take(frame);
    if (tf_->frames().count(frame_->name()) == 0) take({frame_->name(), "", 0});
    for (const auto& [character, body] : bodies_) {
      for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
        const std::string link = urdf::LinkName(body.model, segment);
        if (tf_->frames().count(link) > 0) continue;
        take({link, frame_->name(), body.now.stamp_nanos});
      }
    }
  };
  const auto find_now = [this](const std::string& frame) { return PoseOf(Find(frame, 0)); };
  bool has_changed = false;
  for (ShownFrames& frames : frames_) {
    has_changed = frames.Update(now, list, find_now) || has_changed;
  }
  if (std::string lost = frames_.front().TakeLost(); !lost.empty()) {
    const std::lock_guard<std::mutex> lock(mutex_);
    InputCounters& counters = counters_[kNamespaceOfFrames];
    ++counters.refused["unknown frame"];
    counters.last_problem = std::move(lost);
  }
  return has_changed;
}

void MarkerInbox::Deliver(const Now& now, InputSink& sink) {
  const auto find = [this](const std::string& frame, std::int64_t stamp_nanos) {
    return Find(frame, stamp_nanos);
  };
  if (now.graph_nanos < std::exchange(graph_nanos_, now.graph_nanos)) store_.StartAgain(now);
  TakeDecoded(now.graph_nanos);
  if (placed_in_ != frame_->name()) {
    placed_in_ = frame_->name();
    store_.PlaceAgain();
  }
  bool changed = store_.Update(now, find);
  changed = UpdateFrames(now) || changed;
  if (changed) sink.OnMarkers(Together(store_.markers(), frames_));
  images_.Update(now.nanos, find);
  if (images_.TakeChanged()) sink.OnImages(images_.images());
  const auto find_now = [this](const std::string& frame) { return PoseOf(Find(frame, 0)); };
  if (camera_frame_.Update(now.nanos, find_now)) sink.OnCameraBase(*camera_frame_.pose());
  const auto note = [this](const WithoutPlace& lost) {
    const std::string text = TextOf(lost);
    const std::lock_guard<std::mutex> lock(mutex_);
    InputCounters& counters = counters_[topics_[lost.topic].name];
    ++counters.refused["unknown frame"];
    counters.last_problem = text;
  };
  for (const WithoutPlace& lost : store_.TakeLost()) note(lost);
  WarnOfUnplaced(now.nanos);
  for (const WithoutPlace& lost : images_.TakeLost()) note(lost);
}

std::string MarkerInbox::TextOf(const WithoutPlace& lost) const {
  return lost.Text(*tf_, frame_->name());
}

std::map<std::string, InputCounters> MarkerInbox::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

MarkerListener::MarkerListener(std::shared_ptr<MarkerInbox> inbox)
    : inbox_(std::move(inbox)), thread_([this] { Run(); }) {}

MarkerListener::~MarkerListener() {
  stops_ = true;
  queue_.disable();  // wakes it up
  thread_.join();
}

void MarkerListener::Run() {
  constexpr double kAtLeastEvery = 0.1;  // s
  while (!stops_) {
    queue_.callAvailable(ros::WallDuration(kAtLeastEvery));
    inbox_->FinishMessages();
  }
}

std::vector<ros::Subscriber> SubscribeMarkers(ros::NodeHandle& node, MarkerListener& listener) {
  const std::shared_ptr<MarkerInbox>& inbox = listener.inbox();
  std::vector<ros::Subscriber> all;
  const auto subscribe = [&](std::size_t topic, const HeardTopic& heard) {
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const MarkerDecoder::Event&>(
        heard.name, kMarkerQueue,
        [inbox, topic, has_colors = heard.has_colors](const MarkerDecoder::Event& event) {
          inbox->OnMessage(topic, event, has_colors, MonotonicNanos());
        });
    options.callback_queue = &listener.queue();
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    all.push_back(node.subscribe(options));
  };
  for (std::size_t topic = 0; topic < inbox->topics().size(); ++topic) {
    const ShownTopic& shown = inbox->topics()[topic];
    if (shown.is_frame) continue;
    for (const HeardTopic& heard : TopicsHeardFor(shown)) subscribe(topic, heard);
  }
  return all;
}

}  // namespace kinescope::ros_bridge
