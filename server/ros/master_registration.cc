#include "server/ros/master_registration.h"

#include <diagnostic_msgs/DiagnosticArray.h>
#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/ConfigDescription.h>
#include <geometry_msgs/PointStamped.h>
#include <kinescope/LandmarkArray.h>
#include <kinescope/Mark.h>
#include <ros/init.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <rosgraph_msgs/Log.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/MagneticField.h>
#include <sensor_msgs/TimeReference.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>
#include <std_msgs/String.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>
#include <xmlrpcpp/XmlRpcException.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <exception>
#include <utility>

#include "core/system/clocks.h"
#include "core/system/starts_with.h"
#include "core/system/utf8.h"
#include "server/ros/init.h"
#include "server/ros/person_messages.h"
#include "server/ros/raw_message.h"
#include "server/ros/running.h"
#include "server/ros/tcpros_limits.h"
#include "server/ros/xmlrpc_limits.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

// Length of the queue of a slow subscriber before the oldest message is dropped: two seconds at 240
// Hz.
constexpr std::uint32_t kSampleQueue = 480;
constexpr std::uint32_t kMarkQueue = 100;
constexpr std::int64_t kReadRobotsEveryNanos = 3 * kNanosPerSecond;

// A parameter of a launch file has a type, an argument does not: text that is a number becomes one.
XmlRpcValue Typed(const std::string& text) {
  const char* const end = text.data() + text.size();
  int whole = 0;
  if (auto [stop, error] = std::from_chars(text.data(), end, whole);
      error == std::errc() && stop == end) {
    return XmlRpcValue(whole);
  }
  double real = 0;
  if (auto [stop, error] = std::from_chars(text.data(), end, real);
      error == std::errc() && stop == end) {
    return XmlRpcValue(real);
  }
  if (text == "true" || text == "false") return XmlRpcValue(text == "true");
  return XmlRpcValue(text);
}

}  // namespace

MasterRegistration::MasterRegistration(const BridgeConfig& config, InputWiring wiring)
    : config_(config), wiring_(std::move(wiring)), descriptions_(config, master_) {
  status_.master_uri = ros::master::getURI();
  // Otherwise roscpp would retry without limit if the master stops while a topic is registered.
  ros::master::setRetryTimeout(ros::WallDuration(1));
  LimitXmlRpcCalls(kMasterPatience);
  LimitTcprosMessages(kLargestMessage);
  thread_ = std::thread([this] { Run(); });
}

MasterRegistration::~MasterRegistration() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  HurryRoscpp();
  thread_.join();
  orders_.reset();
  if (!node_) return;
  // Callbacks that are still queued will not be called: they hold inboxes, and the queue is
  // destroyed next.
  wiring_.queue->disable();
  wiring_.queue->clear();
  LeaveRos();  // before the publishers, each of which would unregister itself
}

void MasterRegistration::SetPerson(int character, std::shared_ptr<const PersonModel> model) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool is_first = slots_.empty();
    const auto [slot, is_new] = slots_.try_emplace(character);
    if (is_new && is_first) {
      slot->second.topics = first_topics_;
    } else if (is_new) {
      std::string prefix = AsRosName(model->human.model_name) + "/";
      for (const auto& [other, other_slot] : slots_) {
        if (other_slot.prefix == prefix) {
          prefix.insert(prefix.size() - 1, "_" + std::to_string(character));
          break;
        }
      }
      slot->second.prefix = prefix;
    }
    slot->second.model = std::move(model);
    has_work_ = true;
  }
  changed_.notify_all();
}

void MasterRegistration::ReleasePerson(int character) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto slot = slots_.find(character);
  if (slot != slots_.end()) slot->second.model = nullptr;
}

std::shared_ptr<const PersonTopics> MasterRegistration::TopicsOf(int character) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto slot = slots_.find(character);
  return slot == slots_.end() ? nullptr : slot->second.topics;
}

std::shared_ptr<const SensorTopics> MasterRegistration::SensorsOf(
    int character, const std::bitset<urdf::kSegmentCount>& wanted) {
  const std::lock_guard<std::mutex> lock(mutex_);
  Slot& slot = slots_.at(character);
  if ((wanted & ~slot.wanted_sensors).any()) {
    slot.wanted_sensors |= wanted;
    has_work_ = true;
    changed_.notify_all();
  }
  return slot.sensors;
}

std::shared_ptr<RosCameraTopics> MasterRegistration::View() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return view_;
}

std::shared_ptr<const NodeTopics> MasterRegistration::Node() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return node_topics_;
}

void MasterRegistration::WantTransforms() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (wants_transforms_) return;
    wants_transforms_ = true;
    has_work_ = true;
  }
  changed_.notify_all();
}

BridgeStatus MasterRegistration::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  BridgeStatus status = status_;
  status.rejected_calls = RejectedXmlRpc();
  const auto add = [&](const std::string& prefix, const PersonTopics* topics) {
    if (topics == nullptr) return;
    for (auto& [topic, counters] : topics->inputs->counters()) {
      status.inputs[prefix + topic] = counters;
    }
  };
  add("", first_topics_.get());
  if (wiring_.markers) {
    const MarkerInbox& inbox = *wiring_.markers->inbox();
    status.inputs.merge(inbox.counters());
    for (std::string& text : inbox.not_shown()) status.not_shown.push_back(std::move(text));
  }
  if (wiring_.robots) {
    status.inputs.merge(wiring_.robots->counters());
    for (std::string& text : wiring_.robots->not_shown()) {
      status.not_shown.push_back(std::move(text));
    }
  }
  for (const auto& [character, slot] : slots_) {
    if (!slot.prefix.empty()) add(slot.prefix, slot.topics.get());
  }
  return status;
}

bool MasterRegistration::WaitForNext() {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, kAskMasterEvery, [&] { return stopping_ || has_work_; });
  has_work_ = false;
  return !stopping_ && !status_.shutdown_requested;
}

// roscpp throws on values of wrong types, which no answer should contain (master_answers.h).
void MasterRegistration::Run() {
  const auto stop = [&](const std::string& error) {
    spdlog::error("nothing is published to ROS any more: roscpp reported an error: {}", error);
    SetReachable(false);
  };
  try {
    RegisterRegularly();
  } catch (const XmlRpc::XmlRpcException& error) {
    stop(error.getMessage());
  } catch (const std::exception& error) {
    stop(error.what());
  }
}

void MasterRegistration::RegisterRegularly() {
  do {
    bool answers = false;
    const bool is_known = MasterKnowsUs(answers);
    SetReachable(answers);
    if (node_ && !ros::ok()) StopForGood("a ROS shutdown request (rosnode kill)");
    if (!answers || status().shutdown_requested) continue;
    if (!is_known) {
      registered_.clear();
      descriptions_.Forget();
      has_arguments_ = false;
      inputs_.clear();  // roscpp tells a subscriber to a master only once
      transforms_.clear();
      markers_.clear();
      heard_types_.clear();
      joint_states_.clear();
      robots_due_nanos_ = 0;
      marks_.reset();
      orders_are_offered_ = false;
    }
    if (!node_) Start();
    AdvertiseMissing();
    AdvertiseSensors();
    if (!RegisterAll()) continue;
    Subscribe();
    OfferOrders();
    if (!is_known && was_registered_) {
      if (!std::exchange(master_forgot_us_, true)) {
        spdlog::info("the ROS master was restarted: all topics are advertised again");
      }
      const std::lock_guard<std::mutex> lock(mutex_);
      ++status_.master_returns;
    }
    if (is_known) master_forgot_us_ = false;
    was_registered_ = true;
    SetParameters();
    ReadRobots();
    FollowTypes();
    LookForMissingTopics();
  } while (WaitForNext());
}

// A master that was restarted during the registration knows this node by its last topics, but not
// the earlier ones: roscpp waits for a master and continues with the next topic. So the process id
// must be the same, too.
bool MasterRegistration::MasterKnowsUs(bool& answers) {
  const std::string our_uri = node_ ? ros::XMLRPCManager::instance()->getServerURI() : "";
  const RegistrationState state = master_.AskRegistration(our_uri, kMasterPatience);
  if (state == RegistrationState::kNameTaken) StopForGood("another node with the same name");
  const std::optional<int> pid =
      state == RegistrationState::kNoAnswer ? std::nullopt : master_.AskPid(kMasterPatience);
  answers = pid.has_value();
  return answers && std::exchange(master_pid_, pid) == pid && state == RegistrationState::kKnown;
}

void MasterRegistration::Start() {
  WarnOfNamesake();
  node_ = std::make_unique<ros::NodeHandle>("~");
  auto topics = Advertise("");
  std::shared_ptr<RosCameraTopics> view;
  if (wiring_.make_view) {
    view = wiring_.make_view(*node_);
    topic_types_.merge(view->TypesByTopic());
  }
  auto node_topics = std::make_shared<NodeTopics>();
  node_topics->diagnostics = Topic<diagnostic_msgs::DiagnosticArray>("/diagnostics");
  node_topics->log = Topic<rosgraph_msgs::Log>("/rosout");
  node_topics->marks = Topic<kinescope_ros::Mark>("marks");
  node_topics->state = Topic<std_msgs::String>("state", Latch::kYes);
  if (!config_.people_are_of_graph) {
    node_topics->people = Topic<kinescope_ros::PersonArray>(kPeopleTopic, Latch::kYes);
  }
  if (config_.settings.get) {
    node_topics->settings =
        Topic<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", Latch::kYes);
    node_topics->settings_now =
        Topic<dynamic_reconfigure::Config>("parameter_updates", Latch::kYes);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  node_topics_ = std::move(node_topics);
  view_ = std::move(view);
  first_topics_ = std::move(topics);
  for (auto& [character, slot] : slots_) {
    if (slot.prefix.empty()) slot.topics = first_topics_;
  }
}

void MasterRegistration::AdvertiseMissing() {
  std::map<int, std::string> missing;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& [character, slot] : slots_) {
      if (!slot.topics) missing.emplace(character, slot.prefix);
    }
  }
  for (const auto& [character, prefix] : missing) {
    auto topics = Advertise(prefix);
    const std::lock_guard<std::mutex> lock(mutex_);
    slots_[character].topics = std::move(topics);
  }
}

void MasterRegistration::AdvertiseSensors() {
  std::map<int, Slot> due;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& [character, slot] : slots_) {
      const bool is_complete = slot.sensors ? slot.sensors->advertised == slot.wanted_sensors
                                            : slot.wanted_sensors.none();
      if (!is_complete) due.emplace(character, slot);
    }
  }
  for (auto& [character, slot] : due) {
    auto sensors = slot.sensors ? std::make_shared<SensorTopics>(*slot.sensors)
                                : std::make_shared<SensorTopics>();
    for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
      const std::size_t i = urdf::At(segment);
      if (!slot.wanted_sensors.test(i) || sensors->advertised.test(i)) continue;
      const std::string link(urdf::kSegments[i].link_name);
      sensors->imu[i] = Topic<sensor_msgs::Imu>(slot.prefix + "imu/" + link);
      sensors->magnetic_field[i] =
          Topic<sensor_msgs::MagneticField>(slot.prefix + "magnetic_field/" + link);
    }
    sensors->advertised = slot.wanted_sensors;
    const std::lock_guard<std::mutex> lock(mutex_);
    slots_[character].sensors = std::move(sensors);
  }
}

template <class Message>
ros::Publisher MasterRegistration::Topic(const std::string& name, Latch latch) {
  ros::Publisher publisher = node_->advertise<Message>(name, kSampleQueue, latch == Latch::kYes);
  topic_types_[publisher.getTopic()] = ros::message_traits::DataType<Message>::value();
  return publisher;
}

std::shared_ptr<const PersonTopics> MasterRegistration::Advertise(const std::string& prefix) {
  auto topics = std::make_shared<PersonTopics>();
  topics->joint_states = Topic<sensor_msgs::JointState>(prefix + "joint_states");
  topics->link_states = Topic<xsens_mvn_ros_msgs::LinkStateArray>(prefix + "link_states");
  topics->com = Topic<geometry_msgs::Point>(prefix + "com");
  topics->com_stamped = Topic<geometry_msgs::PointStamped>(prefix + "com_stamped");
  topics->cop = Topic<geometry_msgs::PointStamped>(prefix + "cop");
  topics->markers = Topic<visualization_msgs::MarkerArray>(prefix + "markers");
  topics->joint_loads = Topic<kinescope_ros::JointLoadArray>(prefix + "joint_loads");
  topics->landmarks = Topic<kinescope_ros::LandmarkArray>(prefix + "landmarks");
  topics->time_code = Topic<sensor_msgs::TimeReference>(prefix + "time_code");
  topics->utc = Topic<sensor_msgs::TimeReference>(prefix + "utc");
  topics->inputs = inboxes_[prefix] = wiring_.make_inbox();
  if (config_.tf != "none" || config_.people_are_of_graph)
    topics->tf = Topic<tf2_msgs::TFMessage>("/tf");
  return topics;
}

void MasterRegistration::Subscribe() {
  for (const auto& [prefix, inbox] : inboxes_) {
    if (inputs_.count(prefix) != 0) continue;
    ForceSubscriptions all = SubscribeForces(*node_, prefix, *wiring_.queue, inbox);
    if (all.AreComplete()) inputs_[prefix] = std::move(all);  // else the master has just stopped
  }
  if (wiring_.markers && markers_.empty()) {
    markers_ = SubscribeMarkers(*node_, *wiring_.markers);
    markers_since_nanos_ = MonotonicNanos();
  }
  if (wiring_.robots && joint_states_.empty()) {
    joint_states_ = SubscribeJointStates(*node_, *wiring_.queue, wiring_.robots);
  }
  if (!marks_) marks_ = SubscribeMarks();
  bool wants_transforms =
      config_.people_are_of_graph || wiring_.markers != nullptr || wiring_.robots != nullptr;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    wants_transforms = wants_transforms || wants_transforms_;
  }
  if (!wants_transforms || !transforms_.empty()) return;
  transforms_ = {SubscribeTransforms("/tf", false), SubscribeTransforms("/tf_static", true)};
}

void MasterRegistration::OfferOrders() {
  const bool has_any = config_.orders.snapshot || config_.settings.get;
  if (!has_any || orders_are_offered_) return;
  if (!orders_) {
    orders_ = std::make_unique<OrderServices>(config_.orders, config_.settings, *Node());
  }
  orders_->Advertise(*node_);
  orders_are_offered_ = true;
}

// RViz reads a description when the display is enabled; here a robot that is started later, or
// again, is shown without a click.
void MasterRegistration::ReadRobots() {
  const std::int64_t now = MonotonicNanos();
  if (!wiring_.robots || now < robots_due_nanos_) return;
  robots_due_nanos_ = now + kReadRobotsEveryNanos;
  for (std::size_t i = 0; i < wiring_.robots->size(); ++i) {
    const std::string parameter = wiring_.robots->ParameterOf(i);
    if (parameter.empty()) continue;
    XmlRpcValue arguments;
    arguments[0] = parameter;
    MasterReply set = master_.Call("getParam", arguments);
    if (!set.problem.empty()) wiring_.robots->SetProblem(i, set.problem);
    if (set.code == MasterReply::Code::kNoAnswer) return;
    const bool is_set = set.code == MasterReply::Code::kGood;
    const bool is_text = is_set && set.value.getType() == XmlRpcValue::TypeString;
    if (is_set && !is_text) {
      wiring_.robots->SetProblem(i, "the parameter is no text; expected a URDF");
    }
    wiring_.robots->SetDescription(
        i, is_text ? std::optional(static_cast<std::string&>(set.value)) : std::nullopt);
  }
}

// As the master has them.
std::map<std::string, std::string> MasterRegistration::TypesOfHeardTopics() {
  std::set<std::string> heard;
  for (const auto* subscribers : {&markers_, &transforms_}) {
    for (const ros::Subscriber& subscriber : *subscribers) heard.insert(subscriber.getTopic());
  }
  std::map<std::string, std::string> types;
  MasterReply reply = master_.Call("getTopicTypes", XmlRpcValue());
  const bool is_list =
      reply.code == MasterReply::Code::kGood && reply.value.getType() == XmlRpcValue::TypeArray;
  for (int i = 0; is_list && i < reply.value.size(); ++i) {
    XmlRpcValue& topic = reply.value[i];  // [name, type]
    const bool is_pair = topic.getType() == XmlRpcValue::TypeArray && topic.size() == 2 &&
                         topic[0].getType() == XmlRpcValue::TypeString &&
                         topic[1].getType() == XmlRpcValue::TypeString;
    if (!is_pair) continue;
    const std::string name = topic[0], type = topic[1];
    if (heard.count(name) > 0 && type != "*") types[name] = type;
  }
  return types;
}

// roscpp keeps to the type of the first publisher of a topic: one of another type is turned away
// without a word, also when the first has ended.
void MasterRegistration::FollowTypes() {
  constexpr std::int64_t kEveryNanos = 3'000'000'000;
  const std::int64_t now = MonotonicNanos();
  const bool hears_nothing = markers_.empty() && transforms_.empty();
  if (hears_nothing || now - types_asked_nanos_ < kEveryNanos) return;
  types_asked_nanos_ = now;
  bool has_changed = false;
  for (const auto& [name, type] : TypesOfHeardTopics()) {
    const std::string before = std::exchange(heard_types_[name], type);
    if (before == type) continue;
    if (const bool is_static = name == "/tf_static"; is_static || name == "/tf") {
      if (type == "tf2_msgs/TFMessage" || type == "tf/tfMessage") continue;
      Refuse(is_static ? "/tf_static" : "/tf",
             {"another type", "a node publishes it as " +
                                  PrintableLine(type.substr(0, kLongestTypeName)) +
                                  ", not tf2_msgs/TFMessage"});
      continue;
    }
    if (before.empty() || !wiring_.markers) continue;
    has_changed = true;
    wiring_.markers->inbox()->Erase(name);
    spdlog::info("{} has another type now: {}, formerly {}", name,
                 PrintableLine(type.substr(0, kLongestTypeName)),
                 PrintableLine(before.substr(0, kLongestTypeName)));
  }
  if (!has_changed) return;
  markers_.clear();
  markers_ = SubscribeMarkers(*node_, *wiring_.markers);
}

// A name may be mistyped: the log has that once, the status as long as it is so.
void MasterRegistration::LookForMissingTopics() {
  constexpr std::int64_t kTopicPatienceNanos = 5'000'000'000;
  if (markers_.empty() || MonotonicNanos() - markers_since_nanos_ < kTopicPatienceNanos) return;
  std::set<std::string> missing;
  for (const ShownTopic& shown : wiring_.markers->inbox()->topics()) {
    const bool is_missing = std::any_of(markers_.begin(), markers_.end(), [&](const auto& heard) {
      return heard.getTopic() == shown.name && heard.getNumPublishers() == 0;
    });
    if (is_missing && !shown.is_frame) missing.insert(shown.name);
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.not_shown.clear();
    for (const std::string& topic : missing) {
      status_.not_shown.push_back(topic + ": no node publishes it");
    }
  }
  if (std::exchange(has_looked_for_topics_, true) || missing.empty()) return;
  spdlog::warn("no publisher of {} (--marker_topics); messages are shown once there is one",
               fmt::join(missing, ", "));
}

ros::Subscriber MasterRegistration::SubscribeMarks() {
  using Heard = BoundedMessage<std_msgs::String>;
  auto options = ros::SubscribeOptions::create<Heard>(
      "mark", kMarkQueue,
      [this](const boost::shared_ptr<const Heard>& heard) {
        if (!heard->is_sound) return Refuse("mark", Unreadable());
        wiring_.on_mark(heard->message.data);
      },
      ros::VoidConstPtr(), wiring_.queue);
  return node_->subscribe(options);
}

// Of any type: roscpp drops a publisher of another one without a word, and it tries again and
// again.
ros::Subscriber MasterRegistration::SubscribeTransforms(const char* topic, bool is_static) {
  ros::SubscribeOptions options;
  options.initByFullCallbackType<const RawEvent&>(
      topic, kSampleQueue, [this, topic, is_static](const RawEvent& event) {
        if (event.getPublisherName() == ros::this_node::getName()) return;
        if (!Is<tf2_msgs::TFMessage>(Said(event, "md5sum"))) {
          return Refuse(topic,
                        {"another type", event.getPublisherName() + " sends " +
                                             Said(event, "type").substr(0, kLongestTypeName) +
                                             ", not tf2_msgs/TFMessage"});
        }
        tf2_msgs::TFMessage message;
        if (!Decode(event.getConstMessage()->bytes, message)) return Refuse(topic, Unreadable());
        for (const Refusal& refusal : wiring_.on_transforms(message, is_static)) {
          Refuse(topic, refusal);
        }
      });
  options.callback_queue = wiring_.queue;
  return node_->subscribe(options);
}

void MasterRegistration::Refuse(const char* topic, const Refusal& refusal) {
  bool is_first = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_first = CountRefused(refusal, status_.inputs[topic]);
  }
  if (is_first) WarnOfRefused(topic, refusal);
}

// roscpp registers a topic when it is advertised, and never again. So topics are registered at
// every master that does not know this node; at the first one twice, which has no effect. Only the
// registration check shows whether it arrived.
bool MasterRegistration::RegisterAll() {
  const std::string our_uri = ros::XMLRPCManager::instance()->getServerURI();
  MasterClient master(ros::master::getHost(), static_cast<int>(ros::master::getPort()),
                      Connection::kKept);
  const auto add = [&](const std::string& topic, const std::string& type) {
    if (registered_.count(topic) != 0) return true;
    XmlRpcValue arguments;
    arguments[0] = topic;
    arguments[1] = type;
    arguments[2] = our_uri;
    if (master.Call("registerPublisher", arguments).code != MasterReply::Code::kGood) return false;
    registered_.insert(topic);
    return true;
  };
  // Over a slow network each takes its time: what all viewers wait for comes first.
  const auto frames = topic_types_.find("/tf");
  if (frames != topic_types_.end() && !add(frames->first, frames->second)) return false;
  return std::all_of(topic_types_.begin(), topic_types_.end(),
                     [&](const auto& each) { return add(each.first, each.second); });
}

// Stops at the first parameter that the master does not accept; the rest is tried again next time.
void MasterRegistration::SetParameters() {
  if (!has_arguments_) {
    for (const auto& [name, value] : PrivateArguments()) {
      if (!master_.SetParameter("~" + name, Typed(value))) return;
    }
    has_arguments_ = true;
  }
  DescriptionParameters::Models models;
  bool has_met_nobody = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    has_met_nobody = slots_.empty();
    for (const auto& [character, slot] : slots_) {
      if (slot.model != nullptr) models[slot.prefix] = slot.model;
    }
  }
  descriptions_.Set(models, has_met_nobody);
}

void MasterRegistration::SetReachable(bool reachable) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string problem = reachable ? "" : master_.problem();
  if (std::exchange(master_problem_, problem) != problem && !problem.empty()) {
    spdlog::warn("the server at {} does not answer as a ROS master: it {}; check ROS_MASTER_URI",
                 status_.master_uri, problem);
  }
  if (reachable == status_.master_reachable) return;
  status_.master_reachable = reachable;
  if (reachable) {
    spdlog::info("ROS master at {} answers", status_.master_uri);
  } else {
    spdlog::warn("ROS master at {} does not answer; still publishing to connected subscribers",
                 status_.master_uri);
  }
}

void MasterRegistration::StopForGood(const char* reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (status_.shutdown_requested) return;
  status_.shutdown_requested = true;
  spdlog::warn("publishing to ROS was stopped by {}", reason);
}

}  // namespace kinescope::ros_bridge
