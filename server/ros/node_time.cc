#include "server/ros/node_time.h"

#include <ros/this_node.h>
#include <ros/xmlrpc_manager.h>
#include <spdlog/spdlog.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <exception>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "core/system/clocks.h"
#include "core/system/utf8.h"
#include "server/ros/master_client.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

constexpr char kMethod[] = "kinescope_time";
constexpr std::chrono::seconds kAskEvery(2);
constexpr std::chrono::seconds kPatience(1);
constexpr int kRestOfStrangers = 30;  // rounds between questions to a node that does not tell

// [name of the node, ns since 1970 as text: XML-RPC has no numbers of 64 bits]
void Answer(XmlRpcValue&, XmlRpcValue& result) {
  result[0] = 1;
  result[1] = std::string();
  result[2][0] = ros::this_node::getName();
  result[2][1] = std::to_string(WallNanos());
}

// @throws XmlRpcException, std::runtime_error if `value` is something else
std::int64_t TimeIn(XmlRpcValue& value, const std::string& node) {
  if (static_cast<std::string>(value[0]) != node) throw std::runtime_error("another node answers");
  const std::string text = value[1];
  std::int64_t nanos = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), nanos);
  constexpr std::int64_t kLast = 4'294'967'295'000'000'000;  // of ROS
  const bool is_time = read.ec == std::errc() && read.ptr == text.data() + text.size() &&
                       nanos > 0 && nanos <= kLast;
  if (!is_time) throw std::runtime_error("its answer is no time");
  return nanos;
}

// The connection to a node.
class Line {
 public:
  explicit Line(std::string node) : node_(std::move(node)) {}

  std::optional<RoundTrip> Ask() {
    if (rest_ > 0) {
      --rest_;
      return std::nullopt;
    }
    if (!client_ && !Connect()) return std::nullopt;
    RoundTrip trip;
    trip.sent = MonotonicNanos();
    MasterReply reply = client_->Call(kMethod, XmlRpcValue(), kPatience);
    trip.received = MonotonicNanos();
    if (reply.code != MasterReply::Code::kGood) {
      const bool is_stranger = reply.code == MasterReply::Code::kRefused || !reply.problem.empty();
      if (is_stranger) rest_ = kRestOfStrangers;
      client_.reset();
      return std::nullopt;
    }
    try {
      trip.theirs = TimeIn(reply.value, node_);
    } catch (...) {
      rest_ = kRestOfStrangers;
      client_.reset();
      throw;
    }
    return trip;
  }

 private:
  // The first answer also has the time that the connection takes: it is not a measurement.
  bool Connect() {
    const std::optional<NodeServer> server = FindNodeServer(node_, kPatience);
    if (!server) return false;
    client_ = std::make_unique<MasterClient>(server->host, server->port, Connection::kKept);
    client_->Call(kMethod, XmlRpcValue(), kPatience);
    return true;
  }

  const std::string node_;
  std::unique_ptr<MasterClient> client_;  // null: to be looked up
  int rest_ = 0;                          // rounds
};

}  // namespace

void AnswerWithTime() { ros::XMLRPCManager::instance()->bind(kMethod, Answer); }

TimeQuestion QuestionTo(const std::string& node) {
  return [line = std::make_shared<Line>(node)] {
    try {
      return line->Ask();
    } catch (const XmlRpc::XmlRpcException& error) {  // is no std::exception
      throw std::runtime_error("an answer of another type: " + error.getMessage());
    }
  };
}

NodeTimes::NodeTimes(std::function<TimeQuestion(const std::string& node)> question_to)
    : question_to_(std::move(question_to)), thread_([this] { Run(); }) {}

NodeTimes::~NodeTimes() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void NodeTimes::SetNodes(std::vector<std::string> nodes) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (nodes == nodes_) return;
    nodes_ = std::move(nodes);
  }
  changed_.notify_all();
}

std::vector<std::pair<std::string, RoundTrip>> NodeTimes::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(answers_, {});
}

std::uint64_t NodeTimes::failures() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failures_;
}

void NodeTimes::Ask(const std::string& name) {
  Node& node = asked_[name];
  try {
    if (!node.ask) node.ask = question_to_(name);
    const auto trip = node.ask();
    const std::lock_guard<std::mutex> lock(mutex_);
    if (trip) answers_.emplace_back(name, *trip);
  } catch (const std::exception& error) {
    if (!std::exchange(node.has_failed, true)) {
      spdlog::warn("{} was asked for its time: {}", PrintableLine(name),
                   PrintableLine(error.what()));
    }
    const std::lock_guard<std::mutex> lock(mutex_);
    ++failures_;
  }
}

void NodeTimes::Run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopping_) {
    const std::vector<std::string> nodes = nodes_;
    lock.unlock();
    for (auto node = asked_.begin(); node != asked_.end();) {
      const bool is_wanted = std::count(nodes.begin(), nodes.end(), node->first) > 0;
      node = is_wanted ? std::next(node) : asked_.erase(node);
    }
    for (const std::string& node : nodes) {
      Ask(node);
      const std::lock_guard<std::mutex> look(mutex_);
      if (stopping_) break;
    }
    lock.lock();
    changed_.wait_for(lock, kAskEvery, [&] { return stopping_ || nodes_ != nodes; });
  }
}

}  // namespace kinescope::ros_bridge
