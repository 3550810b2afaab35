#include "server/ros/source/live_topics.h"

#include <ros/init.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <spdlog/spdlog.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <algorithm>
#include <exception>
#include <utility>

#include "core/system/stop_signal.h"
#include "server/ros/init.h"
#include "server/ros/tcpros_limits.h"
#include "server/ros/xmlrpc_limits.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

// Length of the queue before the oldest message is dropped. /tf is shared: two seconds of a person
// at 240 Hz with one message per transform.
constexpr std::uint32_t kSegmentQueue = 2 * 240 * urdf::kSegmentCount;

// The messages that are left then are passed on by the next call: a publisher that floods must not
// keep the reading thread from its other work.
constexpr std::chrono::milliseconds kLongestTake(20);

std::set<std::string> Strings(XmlRpcValue& list) {
  std::set<std::string> strings;
  if (list.getType() != XmlRpcValue::TypeArray) return strings;
  for (int i = 0; i < list.size(); ++i) {
    if (list[i].getType() == XmlRpcValue::TypeString) strings.insert(list[i]);
  }
  return strings;
}

}  // namespace

LiveTopics::LiveTopics(std::vector<std::string> topics, std::string description,
                       OnMessage on_message)
    : topics_(std::move(topics)),
      description_(std::move(description)),
      on_message_(std::move(on_message)) {
  status_.publishers.resize(topics_.size());
  // Otherwise roscpp would retry without limit if the master stops while a topic is registered.
  ros::master::setRetryTimeout(ros::WallDuration(1));
  LimitXmlRpcCalls(kMasterPatience);
  LimitTcprosMessages(kLargestMessage);
  thread_ = std::thread([this] { Run(); });
}

LiveTopics::~LiveTopics() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  HurryRoscpp();
  thread_.join();
  if (node_) LeaveRos();  // before the subscribers, each of which would unregister itself
}

void LiveTopics::Take(std::chrono::milliseconds timeout) {
  const auto start = std::chrono::steady_clock::now();
  ros::WallDuration wait(std::chrono::duration<double>(timeout).count());
  while (queue_.callOne(wait) == ros::CallbackQueue::Called &&
         std::chrono::steady_clock::now() - start < timeout + kLongestTake) {
    wait = ros::WallDuration(0);
  }
}

LiveTopics::Status LiveTopics::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return status_;
}

// roscpp throws on values of wrong types, which no answer should contain (master_answers.h).
void LiveTopics::Run() {
  try {
    AskRegularly();
  } catch (const XmlRpc::XmlRpcException& error) {
    StopForGood("an error of roscpp: " + error.getMessage());
  } catch (const std::exception& error) {
    StopForGood(std::string("an error of roscpp: ") + error.what());
  }
}

void LiveTopics::AskRegularly() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_ && !status_.shutdown_requested) {
    lock.unlock();
    Ask();
    lock.lock();
    changed_.wait_for(lock, kAskMasterEvery, [&] { return stopping_; });
  }
}

void LiveTopics::Ask() {
  if (StopRequested()) return;  // roscpp may have been left already
  const std::string our_uri = node_ ? ros::XMLRPCManager::instance()->getServerURI() : "";
  const RegistrationState state = master_.AskRegistration(our_uri, kMasterPatience);
  if ((node_ && !ros::ok()) || state == RegistrationState::kNameTaken) {
    return StopForGood("rosnode kill, or another node named " + ros::this_node::getName());
  }
  SetMasterAnswers(state != RegistrationState::kNoAnswer);
  if (state == RegistrationState::kNoAnswer) return;
  if (!node_) node_ = std::make_unique<ros::NodeHandle>();
  SubscribeMissing();
  // Registering again has no effect on a registered node. A master that has forgotten only the
  // subscription cannot be distinguished from one that knows it.
  for (const std::string& topic : topics_) Register(topic);
  std::vector<std::size_t> publishers;
  for (const ros::Subscriber& subscriber : subscribers_) {
    publishers.push_back(subscriber.getNumPublishers());
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.publishers = std::move(publishers);
}

// roscpp makes no subscription if the master does not accept it.
void LiveTopics::SubscribeMissing() {
  subscribers_.resize(topics_.size());
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    if (subscribers_[i]) continue;
    ros::SubscribeOptions options;
    options.initByFullCallbackType<const Event&>(
        topics_[i], kSegmentQueue, [this, i](const Event& event) { on_message_(i, event); });
    options.callback_queue = &queue_;
    options.transport_hints = ros::TransportHints().tcpNoDelay();
    subscribers_[i] = node_->subscribe(options);
  }
}

void LiveTopics::Register(const std::string& topic) {
  XmlRpcValue arguments;
  arguments[0] = topic;
  arguments[1] = "*";
  arguments[2] = ros::XMLRPCManager::instance()->getServerURI();
  MasterReply reply = master_.Call("registerSubscriber", arguments);
  if (reply.code != MasterReply::Code::kGood) return;  // tried again in a second
  MasterClient ourselves(ros::network::getHost(),
                         static_cast<int>(ros::XMLRPCManager::instance()->getServerPort()));
  const std::set<std::string> heard = ConnectedPublishers(topic, ourselves);
  std::set<std::string> wanted = Strings(reply.value);
  wanted.merge(Orphans(topic, heard, wanted));
  if (std::includes(heard.begin(), heard.end(), wanted.begin(), wanted.end())) return;
  // As the master reports new publishers; those that are missing in the list are disconnected.
  wanted.insert(heard.begin(), heard.end());
  XmlRpcValue update;
  update[0] = topic;
  int count = 0;
  for (const std::string& uri : wanted) update[1][count++] = uri;
  ourselves.Call("publisherUpdate", update);
}

std::set<std::string> LiveTopics::Orphans(const std::string& topic,
                                          const std::set<std::string>& heard,
                                          const std::set<std::string>& known) {
  constexpr int kMaxTries = 5;  // one second each: then it no longer exists
  std::map<std::string, int>& orphans = orphans_[topic];
  for (const std::string& uri : heard) {
    if (known.count(uri) == 0) orphans[uri] = 0;
  }
  std::set<std::string> uris;
  for (auto orphan = orphans.begin(); orphan != orphans.end();) {
    const std::string& uri = orphan->first;
    const bool is_lost = heard.count(uri) == 0 && ++orphan->second > kMaxTries;
    if (is_lost || known.count(uri) > 0) {
      orphan = orphans.erase(orphan);
      continue;
    }
    uris.insert(uri);
    ++orphan;
  }
  return uris;
}

std::set<std::string> LiveTopics::ConnectedPublishers(const std::string& topic,
                                                      MasterClient& ourselves) {
  std::set<std::string> uris;
  MasterReply reply = ourselves.Call("getBusInfo", XmlRpcValue());
  if (reply.value.getType() != XmlRpcValue::TypeArray) return uris;
  for (int i = 0; i < reply.value.size(); ++i) {
    // [connection, publisher, "i" for incoming, transport, topic, ...]
    XmlRpcValue& connection = reply.value[i];
    const bool is_ours = connection.getType() == XmlRpcValue::TypeArray && connection.size() >= 5 &&
                         connection[1].getType() == XmlRpcValue::TypeString &&
                         connection[2] == XmlRpcValue("i") && connection[4] == XmlRpcValue(topic);
    if (is_ours) uris.insert(connection[1]);
  }
  return uris;
}

void LiveTopics::SetMasterAnswers(bool answers) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const std::string problem = answers ? "" : master_.problem();
  if (std::exchange(master_problem_, problem) != problem && !problem.empty()) {
    spdlog::warn(
        "{}: the server at {} does not answer as a ROS master: it {}; check ROS_MASTER_URI",
        description_, ros::master::getURI(), problem);
  }
  if (has_asked_ && answers == status_.master_answers) return;
  const bool was_asked = std::exchange(has_asked_, true);
  status_.master_answers = answers;
  if (answers) {
    spdlog::info("{}: subscribed through the ROS master at {}", description_,
                 ros::master::getURI());
  } else if (was_asked) {
    spdlog::warn("{}: the ROS master at {} does not answer; existing connections stay open",
                 description_, ros::master::getURI());
  } else if (problem.empty()) {
    spdlog::info("{}: waiting for a ROS master at {}", description_, ros::master::getURI());
  }
}

void LiveTopics::StopForGood(const std::string& reason) {
  const std::lock_guard<std::mutex> lock(mutex_);
  status_.shutdown_requested = true;
  spdlog::warn("{}: stopped by {}", description_, reason);
}

}  // namespace kinescope::ros_bridge
