#include "server/ros/bridge.h"

#include <geometry_msgs/Point.h>
#include <ros/time.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <bitset>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <map>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/ros/force_inbox.h"
#include "server/ros/init.h"
#include "server/ros/joint_loads.h"
#include "server/ros/joint_states.h"
#include "server/ros/link_states.h"
#include "server/ros/marker_topics.h"
#include "server/ros/markers.h"
#include "server/ros/master_client.h"
#include "server/ros/master_registration.h"
#include "server/ros/names.h"
#include "server/ros/node_topics.h"
#include "server/ros/person_messages.h"
#include "server/ros/robot_inbox.h"
#include "server/ros/ros_camera_topics.h"
#include "server/ros/ros_clock.h"
#include "server/ros/stamp.h"
#include "server/ros/stream_status.h"
#include "server/ros/suit_messages.h"
#include "server/ros/transforms.h"

namespace kinescope::ros_bridge {
namespace {

// Outputs of one person. Messages are reused from sample to sample, with their memory and names.
struct Outlet {
  explicit Outlet(const PersonState& person) : model(person.model), names(person.model->human) {}

  std::shared_ptr<const PersonModel> model;
  PersonNames names;
  std::shared_ptr<const PersonTopics> topics;  // null until registered

  bool has_last = false;
  // Counter and stamp of the newest sample, before it was given the graph's time.
  std::optional<std::pair<std::uint32_t, std::int64_t>> came;
  std::int64_t last_stamp_nanos = 0;
  double period_secs = 0;            // between the last two samples; 0: not known
  std::uint64_t seen_in_number = 0;  // of the last live state that had this person

  sensor_msgs::JointState joint_states;
  xsens_mvn_ros_msgs::LinkStateArray link_states;
  geometry_msgs::PointStamped com, cop;
  visualization_msgs::MarkerArray markers;
  kinescope_ros::JointLoadArray joint_loads;
  tf2_msgs::TFMessage transforms;

  std::int64_t frames_seen_nanos = 0;  // monotonic clock; those of another node; 0: not yet
  std::optional<bool> is_complete;     // whether that node has all frames; once it is known

  std::shared_ptr<const SensorTopics> sensors;  // null until registered
  sensor_msgs::Imu imu;
  sensor_msgs::MagneticField magnetic_field;
  urdf::Landmarks landmarks;  // empty until there is a subscriber
  kinescope_ros::LandmarkArray landmark_array;
  sensor_msgs::TimeReference time;
};

// What others were told of one person comes from these.
struct Told {
  std::shared_ptr<const PersonModel> model;
  HandLoad hand_load;
};

TfShape ShapeOf(const std::string& tf) {
  if (tf == "flat") return TfShape::kFlat;
  return tf == "tree" ? TfShape::kTree : TfShape::kBase;
}

// `sample` has the stamp of its source: that by a simulated clock is computed for each state anew.
bool IsNew(const BodySample& sample, const Outlet& outlet) {
  return outlet.came != std::make_pair(sample.counter, sample.stamp_nanos);
}

// `state` with stamps of the graph's clock, which must have a time.
SceneState InRosTime(SceneState state, const RosClock& clock) {
  const auto convert = [&](std::int64_t& stamp_nanos) { stamp_nanos = *clock.ToRos(stamp_nanos); };
  convert(state.stamp_nanos);
  for (PersonState& person : state.people) convert(person.sample.stamp_nanos);
  for (TrackedObject& object : state.objects) convert(object.stamp_nanos);
  return state;
}

// Passes on what comes from ROS with stamps of the wall clock.
class InWallTime : public InputSink {
 public:
  InWallTime(InputSink& sink, const RosClock& clock) : sink_(sink), clock_(clock) {}

  void OnHandLoad(int character, const HandLoad& load) override {
    sink_.OnHandLoad(character, load);
  }
  void OnMeasurements(int character, const Measurements& measured) override {
    Measurements in_wall_time = measured;
    const auto convert = [&](auto& part) {
      if (part) part->stamp_nanos = clock_.FromRos(part->stamp_nanos);
    };
    for (auto& hand : in_wall_time.hands) convert(hand);
    for (auto& foot : in_wall_time.feet) convert(foot);
    convert(in_wall_time.ground);
    for (ExternalJointLoad& joint : in_wall_time.joints) {
      if (joint.stamp_nanos != 0) joint.stamp_nanos = clock_.FromRos(joint.stamp_nanos);
    }
    sink_.OnMeasurements(character, in_wall_time);
  }
  void OnMarkers(const MarkerList& markers) override { sink_.OnMarkers(markers); }
  void OnImages(const ImageList& images) override { sink_.OnImages(images); }
  void OnRobots(const RobotList& robots) override { sink_.OnRobots(robots); }
  void OnCameraBase(const urdf::Pose& pose) override { sink_.OnCameraBase(pose); }
  void OnMark(const std::string& text) override { sink_.OnMark(text); }
  void OnViewListeners(int count) override { sink_.OnViewListeners(count); }

 private:
  InputSink& sink_;
  const RosClock& clock_;
};

class Bridge : public RosBridge {
 public:
  explicit Bridge(const BridgeConfig& config)
      : config_(config), registration_(config_, MakeWiring()) {}

  void PublishView(const RosImage& picture) override {
    const auto view = registration_.View();
    if (!view) return;
    RosImage of_graph = picture;
    if (of_graph.stamp_nanos != 0) of_graph.stamp_nanos = RosStamp(picture.stamp_nanos);
    view->Publish(of_graph);
  }

  void PublishDiagnostics(std::vector<Diagnosis> all, double suit_hz) override {
    const auto node = registration_.Node();
    if (!node) return;
    if (!status_) status_.emplace();
    const std::vector<Diagnosis> of_samples = status_->Diagnose(suit_hz);
    all.insert(std::next(all.begin(), all.empty() ? 0 : 1), of_samples.begin(), of_samples.end());
    ros_bridge::PublishDiagnostics(all, *node);
  }

  bool PublishState(const std::string& state) override {
    const auto node = registration_.Node();
    if (!node) return false;
    if (state == "lost") DeleteMarkers();
    if (state == "live") status_.emplace();  // rates count from here
    ros_bridge::PublishState(state, *node);
    return true;
  }

  bool PublishLog(const RosLogLine& line) override {
    const auto node = registration_.Node();
    return node && ros_bridge::PublishLog(line, *node);
  }

  bool PublishMark(const RosMark& mark) override {
    const auto node = registration_.Node();
    if (!node) return false;
    RosMark of_graph = mark;
    of_graph.stamp_nanos = RosStamp(mark.stamp_nanos);
    if (mark.end_stamp_nanos) of_graph.end_stamp_nanos = RosStamp(*mark.end_stamp_nanos);
    ros_bridge::PublishMark(of_graph, config_.reference_frame, *node);
    return true;
  }

  void TakeInputs(InputSink& to) override {
    InWallTime in_wall_time(to, clock_);
    InputSink& sink = clock_.has_time() ? static_cast<InputSink&>(in_wall_time) : to;
    const std::int64_t now = MonotonicNanos();
    const std::int64_t graph_now = IsSimulated() ? ToNanos(ros::Time::now()) : now;
    const bool is_set_back = graph_now < std::exchange(graph_nanos_, graph_now);
    if (is_set_back) transforms_->StartAgain(graph_now);
    queue_.callAvailable(ros::WallDuration(0));
    for (const std::string& text : std::exchange(marks_in_, {})) sink.OnMark(text);
    if (view_listeners_) sink.OnViewListeners(*std::exchange(view_listeners_, std::nullopt));
    for (auto& [character, outlet] : outlets_) {
      if (outlet.topics) outlet.topics->inputs->Deliver(character, sink);
    }
    if (config_.finds_frame && scene_frame_->IsDue(now)) {
      scene_frame_->Update(now, markers_in_ ? markers_in_->FirstFrame() : "");
      const std::lock_guard<std::mutex> lock(frame_mutex_);
      frame_ = scene_frame_->name();
    }
    // Robots first: their links may be frames of markers.
    if (robots_in_) robots_in_->Deliver(now, is_stale_ ? 0 : shown_stamp_nanos_, sink);
    if (markers_in_) markers_in_->Deliver({now, graph_now}, sink);
  }

  void Publish(const SceneState& state) override {
    if (state.liveness == Liveness::kStale && !is_stale_) PublishStaleMarkers();
    is_stale_ = state.liveness == Liveness::kStale;
    if (state.liveness != Liveness::kLive) return;
    if (!IsSimulated()) return PublishLive(state, state);
    clock_.Observe(WallNanos(), ToNanos(ros::Time::now()));
    if (!clock_.has_time()) return WaitForClock();
    if (std::exchange(jumps_, clock_.jumps()) != clock_.jumps()) ForgetStamps();
    PublishLive(InRosTime(state, clock_), state);
  }

  BridgeStatus status() const override {
    BridgeStatus status = registration_.status();
    status.published = published_;
    status.missed = missed_;
    const std::lock_guard<std::mutex> lock(frame_mutex_);
    status.frame = frame_;
    return status;
  }

 private:
  // Known when roscpp was started.
  bool IsSimulated() const { return registration_.Node() && ros::Time::isSimTime(); }

  // Of what is shown; by the clock as it was at the last sample.
  std::int64_t RosStamp(std::int64_t stamp_nanos) const {
    return clock_.ToRos(stamp_nanos).value_or(stamp_nanos);
  }

  void WaitForClock() {
    ++missed_;
    if (std::exchange(waits_for_clock_, true)) return;
    spdlog::warn(
        "/use_sim_time is true, and nothing has been published on /clock: samples are published "
        "when a simulator or rosbag play --clock does; or rosparam set /use_sim_time false and "
        "start this node again");
  }

  void ForgetStamps() {
    for (auto& [character, outlet] : outlets_) outlet.has_last = false;
  }

  /// `as_it_came`: with the stamps of the source.
  void PublishLive(const SceneState& state, const SceneState& as_it_came) {
    last_live_number_ = state.number;
    shown_stamp_nanos_ = state.stamp_nanos;
    if (!state.people.empty()) scene_frame_->SetPerson();
    TellOfPeople(state);
    for (std::size_t i = 0; i < state.people.size(); ++i) {
      const PersonState& person = state.people[i];
      const BodySample& came = as_it_came.people[i].sample;
      Outlet& outlet = OutletOf(person);
      outlet.seen_in_number = state.number;
      if (markers_in_) markers_in_->SetPerson(person, state.floor_z);
      if (!IsNew(came, outlet)) continue;
      outlet.came.emplace(came.counter, came.stamp_nanos);
      if (!StandsStill(person.sample, outlet)) PublishSample(state, person, outlet);
    }
    ReleaseThoseGone(state.stamp_nanos);
  }

  // Before their first pose, so that a recorder has it first.
  void TellOfPeople(const SceneState& state) {
    const auto node = registration_.Node();
    if (!node || !node->people) return;
    const std::int64_t now = MonotonicNanos();
    const bool is_same = std::equal(state.people.begin(), state.people.end(), told_.begin(),
                                    told_.end(), [](const PersonState& person, const Told& told) {
                                      return told.model == person.model &&
                                             told.hand_load == person.forces.stated_hand_load;
                                    });
    if (is_same && now - told_nanos_ < kTellEveryNanos) return;
    kinescope_ros::PersonArray message;
    std::vector<Told> told;
    for (const PersonState& person : state.people) {
      const Outlet& outlet = OutletOf(person);
      const auto topics = registration_.TopicsOf(person.character);
      if (!topics) return;
      FillPerson(person, outlet.names, NamespaceOf(topics->joint_loads.getTopic()),
                 message.people.emplace_back());
      told.push_back({person.model, person.forces.stated_hand_load});
    }
    told_ = std::move(told);
    told_nanos_ = now;
    node->people.publish(message);
  }

  // tf2 drops, with a warning, a transform with the stamp of the one before.
  bool StandsStill(const BodySample& sample, const Outlet& outlet) const {
    return outlet.has_last && sample.stamp_nanos <= outlet.last_stamp_nanos && clock_.has_time();
  }

  std::shared_ptr<MarkerInbox> MakeMarkerInbox() const {
    const GraphView& shown = config_.shown;
    if (shown.topics.empty() && shown.camera_frame.at.empty()) return nullptr;
    return std::make_shared<MarkerInbox>(shown.topics, shown.camera_frame, scene_frame_,
                                         transforms_, robots_in_);
  }

  std::shared_ptr<RobotInbox> MakeRobotInbox() const {
    if (config_.shown.robots.empty()) return nullptr;
    return std::make_shared<RobotInbox>(config_.shown.robots, scene_frame_, transforms_);
  }

  InputWiring MakeWiring() {
    InputWiring wiring;
    wiring.queue = &queue_;
    wiring.make_inbox = [this] {
      return std::make_shared<ForceInbox>(
          ForceSettings{config_.reference_frame, config_.external_scale, config_.check_hand_load,
                        transforms_, [this] { registration_.WantTransforms(); }});
    };
    wiring.on_transforms = [this](const tf2_msgs::TFMessage& message, bool is_static) {
      return transforms_->Add(message, is_static);
    };
    wiring.markers = marker_listener_;
    wiring.robots = robots_in_;
    wiring.on_mark = [this](const std::string& text) { marks_in_.push_back(text); };
    if (!config_.with_view) return wiring;
    wiring.make_view = [this](const ros::NodeHandle& node) {
      return std::make_shared<RosCameraTopics>(node, queue_, config_.reference_frame,
                                               [this](int count) { view_listeners_ = count; });
    };
    return wiring;
  }

  Outlet& OutletOf(const PersonState& person) {
    const auto found = outlets_.find(person.character);
    if (found != outlets_.end() && found->second.model == person.model) return found->second;
    registration_.SetPerson(person.character, person.model);
    if (found == outlets_.end()) {
      return outlets_.emplace(person.character, Outlet(person)).first->second;
    }
    found->second.model = person.model;
    found->second.names = PersonNames(person.model->human);
    found->second.landmarks.clear();
    return found->second;
  }

  // As long after the last sample as the scene forgets a person.
  void ReleaseThoseGone(std::int64_t stamp_nanos) {
    constexpr std::int64_t kGone = 60 * kNanosPerSecond;
    for (auto outlet = outlets_.begin(); outlet != outlets_.end();) {
      const bool is_gone = outlet->second.has_last &&
                           std::abs(stamp_nanos - outlet->second.last_stamp_nanos) > kGone;
      if (is_gone) registration_.ReleasePerson(outlet->first);
      outlet = is_gone ? outlets_.erase(outlet) : std::next(outlet);
    }
  }

  void PublishSample(const SceneState& state, const PersonState& person, Outlet& outlet) {
    outlet.period_secs =
        outlet.has_last ? Secs(person.sample.stamp_nanos - outlet.last_stamp_nanos) : 0;
    outlet.has_last = true;
    outlet.last_stamp_nanos = person.sample.stamp_nanos;
    if (!outlet.topics) outlet.topics = registration_.TopicsOf(person.character);
    if (!outlet.topics) {
      ++missed_;
      return;
    }
    outlet.topics->inputs->SetBody(person, state.floor_z);
    Send(state, person, *outlet.topics, outlet);
    if (status_ && &person == &state.people.front()) status_->OnSample(StampOf(person.sample));
    ++published_;
  }

  using Sensors = std::bitset<urdf::kSegmentCount>;

  // Of the person's sensors, those whose topics have subscribers.
  Sensors HeardSensors(const PersonState& person, Outlet& outlet) {
    const Sensors& sent = person.sample.has_tracker;
    if (sent.none()) return {};
    if (!outlet.sensors || (sent & ~outlet.sensors->advertised).any()) {
      outlet.sensors = registration_.SensorsOf(person.character, sent);
    }
    if (!outlet.sensors) return {};
    Sensors heard;
    for (std::size_t i = 0; i < heard.size(); ++i) {
      heard[i] = sent[i] && outlet.sensors->advertised[i] &&
                 outlet.sensors->imu[i].getNumSubscribers() +
                         outlet.sensors->magnetic_field[i].getNumSubscribers() >
                     0;
    }
    return heard;
  }

  static void SendSensors(const PersonState& person, const Sensors& heard, Outlet& outlet) {
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      const std::size_t i = At(segment);
      if (!heard.test(i)) continue;
      FillImu(person, outlet.names, segment, outlet.imu);
      outlet.sensors->imu[i].publish(outlet.imu);
      FillMagneticField(person, outlet.names, segment, outlet.magnetic_field);
      outlet.sensors->magnetic_field[i].publish(outlet.magnetic_field);
    }
  }

  void SendSuit(const PersonState& person, const PersonTopics& topics, Outlet& outlet) const {
    if (topics.landmarks.getNumSubscribers() > 0) {
      if (outlet.landmarks.empty()) outlet.landmarks = LandmarksToPublish(*person.model);
      FillLandmarks(person, outlet.names, outlet.landmarks, config_.reference_frame,
                    outlet.landmark_array);
      topics.landmarks.publish(outlet.landmark_array);
    }
    if (topics.time_code.getNumSubscribers() > 0) {
      FillTimeCode(person.sample, outlet.time);
      topics.time_code.publish(outlet.time);
    }
    if (person.sample.utc_millis_of_day && topics.utc.getNumSubscribers() > 0) {
      FillUtc(person.sample, outlet.time);
      topics.utc.publish(outlet.time);
    }
  }

  // Whether another node publishes the person's segments alone. It may have a second publisher,
  // such as robot_state_publisher, so it is not known at once.
  bool IsIncomplete(Outlet& outlet) const {
    constexpr std::int64_t kListenNanos = 2 * kNanosPerSecond;
    if (outlet.is_complete) return !*outlet.is_complete;
    const std::int64_t now = MonotonicNanos();
    if (outlet.frames_seen_nanos == 0 && transforms_->Knows(outlet.names.links[urdf::kPelvis])) {
      outlet.frames_seen_nanos = now;
    }
    if (outlet.frames_seen_nanos == 0 || now - outlet.frames_seen_nanos < kListenNanos)
      return false;
    outlet.is_complete = transforms_->Knows(outlet.names.between.front()[0]);
    if (!*outlet.is_complete) {
      spdlog::info(
          "no other node publishes the frames of the links inside the joints of {}, which RViz "
          "needs: "
          "this node does (with --tf=none it does not)",
          outlet.names.model);
    }
    return !*outlet.is_complete;
  }

  // TF is published first, so that a receiver of the other topics can look the frames up.
  void Send(const SceneState& state, const PersonState& person, const PersonTopics& topics,
            Outlet& outlet) {
    const std::string& frame = config_.reference_frame;
    const Sensors heard = HeardSensors(person, outlet);
    const bool is_incomplete = config_.people_are_of_graph && IsIncomplete(outlet);
    if (topics.tf && topics.tf.getNumSubscribers() > 0 && (config_.tf != "none" || is_incomplete)) {
      if (is_incomplete) {
        FillInnerTransforms(person, outlet.names, frame, outlet.transforms);
      } else {
        FillTransforms(person, outlet.names, frame, shape_, outlet.transforms);
      }
      // With any one person's, under the name of the first, who may be away.
      if (&person == &state.people.front()) {
        AddObjects(state, NamesOfFirst(outlet), frame, outlet.transforms);
      }
      AddSensors(person, outlet.names, heard, frame, outlet.transforms);
      topics.tf.publish(outlet.transforms);
    }
    SendSensors(person, heard, outlet);
    SendSuit(person, topics, outlet);
    if (topics.joint_states.getNumSubscribers() > 0 && FillJointStates(person, outlet)) {
      topics.joint_states.publish(outlet.joint_states);
    }
    if (topics.link_states.getNumSubscribers() > 0) {
      FillLinkStates(person, frame, outlet.link_states);
      topics.link_states.publish(outlet.link_states);
    }
    if (person.com) {
      FillPoint(person, frame, *person.com, outlet.com);
      topics.com.publish(outlet.com.point);
      topics.com_stamped.publish(outlet.com);
    }
    if (person.cop) {
      FillPoint(person, frame, *person.cop, outlet.cop);
      topics.cop.publish(outlet.cop);
    }
    if (topics.joint_loads.getNumSubscribers() > 0) {
      FillJointLoads(person, frame, outlet.joint_loads);
      topics.joint_loads.publish(outlet.joint_loads);
    }
    // Filled without a subscriber, too: they may have to turn grey when there is one.
    FillMarkers(person, outlet.names, frame,
                shape_ == TfShape::kBase ? MarkerFrames::kReference : MarkerFrames::kLinks,
                state.floor_z, outlet.markers, MarkerLifetime(outlet.period_secs));
    topics.markers.publish(outlet.markers);
  }

  const PersonNames& NamesOfFirst(const Outlet& otherwise) const {
    const auto first = std::find_if(outlets_.begin(), outlets_.end(),
                                    [](const auto& each) { return each.second.model->index == 0; });
    return first == outlets_.end() ? otherwise.names : first->second.names;
  }

  bool FillJointStates(const PersonState& person, Outlet& outlet) const {
    if (config_.joint_states == "streamed") {
      return FillStreamedJointStates(person, outlet.names, outlet.joint_states);
    }
    FillComputedJointStates(person, outlet.names, outlet.joint_states);
    return true;
  }

  void PublishStaleMarkers() {
    for (auto& [character, outlet] : outlets_) {
      const bool has_left = outlet.seen_in_number != last_live_number_;  // before it stopped
      if (has_left || !outlet.topics || outlet.markers.markers.empty()) continue;
      MakeStale(*outlet.model, outlet.markers);
      outlet.topics->markers.publish(outlet.markers);
    }
  }

  void DeleteMarkers() {
    for (auto& [character, outlet] : outlets_) {
      if (!outlet.topics || outlet.markers.markers.empty()) continue;
      MakeDeleted(outlet.markers);
      outlet.topics->markers.publish(outlet.markers);
      outlet.markers.markers.clear();
    }
  }

  const BridgeConfig config_;
  const TfShape shape_ = ShapeOf(config_.tf);
  RosClock clock_;                     // without a time unless it is simulated
  ros::CallbackQueue queue_;           // called by the publishing thread
  std::optional<int> view_listeners_;  // publishing thread only; until passed on
  std::vector<std::string> marks_in_;  // publishing thread only; until passed on
  const std::shared_ptr<TfTree> transforms_ = std::make_shared<TfTree>();  // publishing thread only
  const std::shared_ptr<SceneFrame> scene_frame_ =
      std::make_shared<SceneFrame>(config_.reference_frame, transforms_);
  const std::shared_ptr<RobotInbox> robots_in_ = MakeRobotInbox();     // null: no robots
  const std::shared_ptr<MarkerInbox> markers_in_ = MakeMarkerInbox();  // null: no marker topics
  const std::shared_ptr<MarkerListener> marker_listener_ =
      markers_in_ ? std::make_shared<MarkerListener>(markers_in_) : nullptr;
  MasterRegistration registration_;
  mutable std::mutex frame_mutex_;
  std::string frame_ = config_.reference_frame;  // of the scene; guarded by frame_mutex_
  std::atomic<std::uint64_t> published_ = 0;
  std::atomic<std::uint64_t> missed_ = 0;

  // Used by the publishing thread only.
  std::map<int, Outlet> outlets_;  // by character
  std::vector<Told> told_;         // to others, of each person
  std::int64_t told_nanos_ = 0;    // then; monotonic clock
  std::optional<StreamStatus>
      status_;  // of the samples of one person at a time; from the first diagnosis on
  bool is_stale_ = false;
  std::int64_t graph_nanos_ = 0;  // clock of the graph, when inputs were taken last
  std::uint64_t last_live_number_ = 0;
  std::int64_t shown_stamp_nanos_ = 0;  // of the newest live state, in the graph's time
  int jumps_ = 0;                       // of clock_, that were noticed
  bool waits_for_clock_ = false;
};

void RequireOneOf(const char* option, const std::string& value,
                  std::initializer_list<std::string_view> allowed) {
  for (const std::string_view good : allowed) {
    if (value == good) return;
  }
  throw UsageError(
      fmt::format("--{}={}: expected one of {}", option, value, fmt::join(allowed, ", ")));
}

void RequireMaster() {
  MasterClient master;
  const MasterReply reply = master.Call("getPid", XmlRpc::XmlRpcValue(), StartPatienceLeft());
  if (reply.code == MasterReply::Code::kGood) return;
  if (!master.problem().empty()) {
    throw UsageError(
        fmt::format("--ros=required: the server at {} does not answer as a ROS master: it {}; set "
                    "ROS_MASTER_URI to the address of a roscore, or use --ros=auto",
                    MasterUri(), master.problem()));
  }
  throw UsageError(fmt::format(
      "--ros=required: no ROS master at {}; start roscore, set ROS_MASTER_URI, or use --ros=auto",
      MasterUri()));
}

}  // namespace

std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& config, RosMode mode) {
  RequireOneOf("tf", config.tf, {"flat", "tree", "off", "none"});
  RequireOneOf("joint_states", config.joint_states, {"computed", "streamed"});
  if (config.reference_frame.empty() || config.reference_frame.front() == '/') {
    throw UsageError(
        fmt::format("--reference_frame={}: expected the name of a TF frame, without a leading /",
                    config.reference_frame));
  }
  if (!(std::abs(config.external_scale) >= 1e-6 && std::abs(config.external_scale) <= 1e6)) {
    throw UsageError(
        fmt::format("--external_scale={}: expected a factor from 1e-6 to 1e6, or from -1e6 to "
                    "-1e-6, such as 1 or -1",
                    config.external_scale));
  }
  if (mode == RosMode::kOff) return nullptr;
  InitRos();
  if (mode == RosMode::kRequired) RequireMaster();
  return std::make_unique<Bridge>(config);
}

}  // namespace kinescope::ros_bridge
