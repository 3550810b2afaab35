#include "server/ros/source/graph_source.h"

#include <ros/master.h>
#include <ros/names.h>
#include <ros/this_node.h>
#include <ros/time.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>
#include <vector>

#include "core/system/check.h"
#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "core/system/wall_offset.h"
#include "server/ros/init.h"
#include "server/ros/names.h"
#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"
#include "server/ros/ros_clock.h"
#include "server/ros/source/common_frame.h"
#include "server/ros/source/link_states_person.h"
#include "server/ros/source/live_topics.h"
#include "server/ros/source/publisher_clocks.h"
#include "server/ros/source/told_people.h"
#include "server/ros/source/transform_people.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

constexpr std::string_view kScheme = "ros:";
constexpr char kMasterAnswers[] = "ros_master_answers", kPublishers[] = "publishers";  // counters
constexpr std::int64_t kSettleNanos = 250'000'000;
constexpr std::int64_t kToldNanos = 2 * kNanosPerSecond;  // nodes that swapped do so for as long
constexpr char kStatic[] = "_static";
constexpr char kUnreadableMessage[] = "is truncated or has a wrong length field";

std::string ToTopic(const std::string& url) {
  const std::string name = url.substr(kScheme.size());
  std::string why;
  if (!ros::names::validate(name, why)) {
    throw SourceError("source '" + url + "': " + why +
                      "; expected ros: or ros:/topic, such as ros:/xsens/link_states");
  }
  std::string topic = ros::names::resolve(name.empty() ? "/tf" : name);
  if (StartsWith(topic, ros::this_node::getName() + "/")) {
    throw SourceError(
        "source '" + url + "': " + ros::this_node::getName() +
        " is this node's own name; start it with another one, such as __name:=kinescope_view");
  }
  return topic;
}

// The master shuts down a node with this node's name as soon as this node registers: probably the
// one to subscribe to.
void RefuseNameOfAnother(const std::string& url) {
  if (!DoesNodeAnswer(ros::this_node::getName(), StartPatienceLeft())) return;
  throw SourceError("source '" + url + "': another running node is already named " +
                    ros::this_node::getName() + "; start this one with __name:=kinescope_view");
}

std::vector<std::string> TopicsBeside(const std::string& topic) {
  std::vector<std::string> names = {topic};
  if (EndsWith(topic, "tf")) names.push_back(topic + kStatic);
  names.push_back(ros::names::resolve(kPeopleTopic));
  return names;
}

// Passes samples on with stamps of the wall clock, which never go back.
class SamplesInWallTime : public SampleSink {
 public:
  SamplesInWallTime(const RosClock& clock, std::map<int, std::int64_t>& newest, SampleSink& sink)
      : clock_(clock), newest_(newest), sink_(sink) {}

  void OnCharacter(const Character& character) override { sink_.OnCharacter(character); }
  void OnSample(const BodySample& sample) override {
    constexpr std::int64_t kMinStepNanos = 1'000;
    BodySample of_wall = sample;
    std::int64_t& newest = newest_[sample.character];
    newest = std::max(newest + kMinStepNanos, clock_.FromRos(sample.stamp_nanos));
    of_wall.stamp_nanos = newest;
    sink_.OnSample(of_wall);
  }

 private:
  const RosClock& clock_;
  std::map<int, std::int64_t>& newest_;
  SampleSink& sink_;
};

// Passes samples on in one frame.
class SamplesInOneFrame : public SampleSink {
 public:
  SamplesInOneFrame(CommonFrame& frame, const TransformPeople& people, SampleSink& sink)
      : frame_(frame), people_(people), sink_(sink) {}

  void OnCharacter(const Character& character) override { sink_.OnCharacter(character); }
  void OnSample(const BodySample& sample) override {
    BodySample in_frame = sample;
    frame_.Bring(in_frame, people_.RootOf(sample.character), people_.root());
    sink_.OnSample(in_frame);
  }

 private:
  CommonFrame& frame_;
  const TransformPeople& people_;
  SampleSink& sink_;
};

class GraphSource : public Source {
 public:
  GraphSource(const std::string& topic, const GraphView& view)
      : description_("ros:" + topic),
        people_(kSettleNanos),
        common_frame_(description_, view.reference_frame),
        link_states_(OwnerOfTopic(topic)),
        names_(TopicsBeside(topic)),
        topics_(names_, description_, [this](std::size_t index, const LiveTopics::Event& event) {
          OnMessage(index, event);
        }) {}

  State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override {
    sink_ = &sink;
    topics_.Take(timeout);
    sink_ = nullptr;
    PassMoment(sink);
    FollowClock();
    clocks_.Update(MonotonicNanos(), wall_.nanos());
    return topics_.status().shutdown_requested ? State::kEnded : State::kMore;
  }

  SourceCounters counters() const override {
    SourceCounters counters = counters_;
    const LiveTopics::Status status = topics_.status();
    counters.transport = {{kMasterAnswers, status.master_answers ? 1 : 0},
                          {kPublishers, PublishersOfPoses(status)}};
    const auto add = [&](const char* name, std::uint64_t count) {
      if (count > 0) counters.transport[name] = count;
    };
    add("clock_steps", clock_steps_);
    add("failed_time_questions", clocks_.failures());
    counters.clocks = clocks_.Report();
    counters.problems = common_frame_.problems();
    const std::int64_t now = MonotonicNanos();
    for (const auto& [frame, sender] : senders_) {
      if (now - sender.told_nanos < kToldNanos) counters.problems.push_back(sender.problem);
    }
    return counters;
  }
  std::string description() const override { return description_; }
  bool is_live() const override { return true; }

 private:
  // Of the frames of a person.
  struct Sender {
    std::string node;
    int swaps = 0;                             // of nodes, in a row
    std::int64_t swapped_nanos = -kToldNanos;  // monotonic clock
    std::string problem;
    std::int64_t told_nanos = -kToldNanos;  // when it was so last; the same
  };

  // Before the first person, time passes while frames come, and where there are none at all.
  void PassMoment(SampleSink& sink) {
    constexpr std::int64_t kEveryNanos = 33 * kNanosPerMilli, kQuietNanos = 2 * kNanosPerSecond;
    const std::int64_t now = MonotonicNanos();
    if (counters_.samples > 0 || now - moment_nanos_ < kEveryNanos) return;
    const bool is_quiet = frames_nanos_ != 0 && now - frames_nanos_ > kQuietNanos;
    if (is_quiet || !topics_.status().master_answers) return;
    moment_nanos_ = now;
    sink.OnMoment({now + wall_.nanos(), now});
  }

  // Once per message: the next stamps of nodes on this machine are of the new time.
  void FollowClock() {
    const std::int64_t before = MonotonicNanos(), wall = WallNanos(), now = MonotonicNanos();
    if (now - before > kNanosPerMilli) return;  // interrupted: the next time
    const std::int64_t set_by = wall_.Read(wall, now);
    if (set_by == 0) return;
    ++clock_steps_;
    newest_arrival_ = 0;
    clocks_.OnOwnClockSet(set_by);
    for (auto& [character, newest] : newest_) newest += set_by;
  }

  // By the clock of the graph, so that stamps in headers can be compared with it.
  Arrival Now() {
    FollowClock();
    const std::int64_t now = MonotonicNanos();
    newest_arrival_ = std::max(newest_arrival_, now + wall_.nanos());
    if (!ros::Time::isSimTime()) return {newest_arrival_, now};
    const std::int64_t of_graph = ToNanos(ros::Time::now());
    clock_.Observe(newest_arrival_, of_graph);
    return {of_graph, now};
  }

  void OnMessage(std::size_t index, const LiveTopics::Event& event) {
    KINESCOPE_CHECK(sink_ != nullptr);
    const RawMessage& raw = *event.getConstMessage();
    ++counters_.datagrams;
    counters_.bytes += raw.bytes.size();
    if (event.getPublisherName() == ros::this_node::getName()) {
      ++counters_.ignored["message published by this node"];
      return;
    }
    const std::string sum = Said(event, "md5sum");
    if (Is<kinescope_ros::PersonArray>(sum)) {
      if (!told_people_.Take(raw.bytes)) Reject(index, kUnreadableMessage);
      return;
    }
    if (sum == ros::message_traits::md5sum<tf2_msgs::TFMessage>()) {
      if (!Decode(raw.bytes, transforms_)) return Reject(index, kUnreadableMessage);
      if (EndsWith(names_[index], kStatic)) {
        common_frame_.Take(transforms_, true);
        return people_.TakeStatic(transforms_, counters_);
      }
      const Arrival now = Now();
      if (!transforms_.transforms.empty()) frames_nanos_ = now.monotonic_nanos;
      const std::int64_t stamp = NewestStamp();
      const std::int64_t shift = ShiftOf(event, stamp, now);
      for (auto& transform : transforms_.transforms) Shift(transform.header.stamp, shift);
      common_frame_.Take(transforms_, false);
      return Take([&](SampleSink& sink) {
        SamplesInOneFrame in_frame(common_frame_, people_, sink);
        told_people_.SetSink(&in_frame);
        const bool has_person = people_.Take(transforms_, now, counters_, told_people_);
        if (!has_person) return;
        OnPerson(event, stamp, now);
        NoteSender(event.getPublisherName(), now.monotonic_nanos);
      });
    }
    if (sum == ros::message_traits::md5sum<xsens_mvn_ros_msgs::LinkStateArray>()) {
      if (!Decode(raw.bytes, link_state_array_)) return Reject(index, kUnreadableMessage);
      const Arrival now = Now();
      const std::int64_t stamp = NewestLinkStamp();
      const std::int64_t shift = ShiftOf(event, stamp, now);
      Shift(link_state_array_.header.stamp, shift);
      for (auto& state : link_state_array_.states) Shift(state.header.stamp, shift);
      return Take([&](SampleSink& sink) {
        told_people_.SetSink(&sink);
        link_states_.Take(link_state_array_, now, origin_, counters_, told_people_);
        OnPerson(event, stamp, now);
      });
    }
    const std::string type = Said(event, "type").substr(0, kLongestTypeName);
    Reject(index, "is a " + (type.empty() ? "message without a type" : type));
  }

  // 0: none, so that of its arrival is taken, later.
  std::int64_t NewestStamp() const {
    ros::Time newest;
    for (const auto& transform : transforms_.transforms) {
      newest = std::max(newest, transform.header.stamp);
    }
    return ToNanos(newest);
  }
  std::int64_t NewestLinkStamp() const {
    ros::Time newest = link_state_array_.header.stamp;
    for (const auto& state : link_state_array_.states) {
      newest = std::max(newest, state.header.stamp);
    }
    return ToNanos(newest);
  }
  // Of a node whose clock differs.
  std::int64_t ShiftOf(const LiveTopics::Event& event, std::int64_t stamp, const Arrival& now) {
    if (stamp == 0 || ros::Time::isSimTime()) return 0;
    return clocks_.OnMessage(event.getPublisherName(), stamp, now.stamp_nanos);
  }
  void OnPerson(const LiveTopics::Event& event, std::int64_t stamp, const Arrival& now) {
    if (stamp == 0 || ros::Time::isSimTime()) return;
    clocks_.OnPerson(event.getPublisherName(), stamp, now.stamp_nanos);
  }
  // Of a person: two nodes that send the same frames look like one who jumps. A node may end, and
  // another one take over.
  void NoteSender(const std::string& node, std::int64_t now) {
    constexpr std::size_t kMost = 64;
    if (transforms_.transforms.empty()) return;
    const std::string& frame = transforms_.transforms.front().child_frame_id;
    if (senders_.size() >= kMost && senders_.count(frame) == 0) return;
    Sender& sender = senders_[frame];
    if (!sender.node.empty() && sender.node != node) NoteSwap(sender, node, frame, now);
    sender.node = node;
  }
  static void NoteSwap(Sender& sender, const std::string& node, const std::string& frame,
                       std::int64_t now) {
    constexpr int kSwaps = 4;
    sender.swaps = now - sender.swapped_nanos < kToldNanos ? sender.swaps + 1 : 1;
    sender.swapped_nanos = now;
    if (sender.swaps < kSwaps) return;
    sender.told_nanos = now;
    if (!sender.problem.empty()) return;
    sender.problem = fmt::format(
        "two nodes, {} and {}, send the frames of one person ('{}'): who is shown jumps "
        "between them; give one of them another --model_name",
        sender.node, node, PrintableLine(frame.substr(0, kLongestTypeName)));
    spdlog::warn("{}", sender.problem);
  }
  static void Shift(ros::Time& stamp, std::int64_t nanos) {
    if (nanos != 0 && !stamp.isZero()) stamp = ToRosTime(ToNanos(stamp) + nanos);
  }

  template <class TakeMessage>
  void Take(const TakeMessage& take) {
    if (!ros::Time::isSimTime()) return take(*sink_);
    if (!clock_.has_time()) {
      ++counters_.ignored["message before there was a time on /clock"];
      return;
    }
    SamplesInWallTime sink(clock_, newest_, *sink_);
    take(sink);
  }

  // Who is told of people alone does not see them.
  static std::size_t PublishersOfPoses(const LiveTopics::Status& status) {
    return std::accumulate(status.publishers.begin(), std::prev(status.publishers.end()),
                           std::size_t{0});
  }

  ToldPeople::Key KeyOf(int character) const {
    const auto& people = people_.people();
    const std::size_t index = urdf::At(character);
    if (index < people.size()) return {people[index].frames[urdf::kPelvis], ""};
    return {"", NamespaceOf(names_.front())};
  }

  void Reject(std::size_t index, const std::string& what) {
    ++counters_.rejected["message on " + names_[index] + " that " + what];
  }

  const std::string description_;
  WallOffset wall_{WallNanos(), MonotonicNanos()};
  std::int64_t frames_nanos_ = 0;          // when the newest frames of TF came; monotonic clock
  std::int64_t moment_nanos_ = 0;          // of the newest moment that was passed on; the same
  std::int64_t newest_arrival_ = 0;        // wall clock; goes back only if that is set
  std::uint64_t clock_steps_ = 0;          // times that it was set
  RosClock clock_;                         // without a time unless it is simulated
  std::map<int, std::int64_t> newest_;     // stamps, by character; if it is
  std::map<std::string, Sender> senders_;  // by the first frame of a message
  PublisherClocks clocks_;
  TransformPeople people_;
  CommonFrame common_frame_;
  LinkStatesPerson link_states_;
  ToldPeople told_people_{[this](int character) { return KeyOf(character); }};
  SampleOrigin origin_;                                  // of `link_states_`
  tf2_msgs::TFMessage transforms_;                       // reused, keeps its memory
  xsens_mvn_ros_msgs::LinkStateArray link_state_array_;  // reused, keeps its memory
  SourceCounters counters_;
  SampleSink* sink_ = nullptr;  // during Poll
  const std::vector<std::string> names_;
  LiveTopics topics_;  // last: it calls this object
};

}  // namespace

bool IsGraphUrl(std::string_view url) { return url.substr(0, kScheme.size()) == kScheme; }

bool HasMaster(const Source& graph) {
  const auto transport = graph.counters().transport;
  const auto answers = transport.find(kMasterAnswers);
  return answers != transport.end() && answers->second > 0;
}

std::string MissingInGraph(const Source& graph) {
  if (!HasMaster(graph)) {
    return fmt::format("no ROS master answers at {}: start roscore, or set ROS_MASTER_URI",
                       ros::master::getURI());
  }
  if (graph.counters().transport.at(kPublishers) > 0) return "";
  return fmt::format(
      "no node publishes {}: start the bridge of a person, or name another topic, such as "
      "ros:/xsens/link_states",
      graph.description().substr(kScheme.size()));
}

std::unique_ptr<Source> OpenGraph(const std::string& url, const GraphView& view) {
  InitRos();
  const std::string topic = ToTopic(url);
  RefuseNameOfAnother(url);
  return std::make_unique<GraphSource>(topic, view);
}

}  // namespace kinescope::ros_bridge
