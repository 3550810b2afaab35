// A master that is restarted in the middle of our own registrations, which no real one can be made
// to do at will: each test runs in a process of its own (bridge_fixture.h).
#include <gmock/gmock.h>
#include <xmlrpcpp/XmlRpcServer.h>
#include <xmlrpcpp/XmlRpcServerMethod.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "tests/server/ros/bridge_fixture.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::IsSupersetOf;
using XmlRpc::XmlRpcValue;

// As much of a master as roscpp and we talk to. It answers on a thread of its own.
class ForgetfulMaster {
 public:
  using Names = std::set<std::string>;

  // Restarts once: the new master gets call number `count` of `method` about `topic`.
  ForgetfulMaster(int port, std::string method, std::string topic, int count)
      : fatal_method_(std::move(method)), fatal_topic_(std::move(topic)), calls_left_(count) {
    for (const char* name : {"getPid", "lookupNode", "registerPublisher", "registerSubscriber",
                             "registerService", "unregisterPublisher", "unregisterSubscriber",
                             "unregisterService", "getParam", "setParam", "hasParam"}) {
      methods_.push_back(std::make_unique<Method>(name, *this));
    }
    EXPECT_TRUE(server_.bindAndListen(port));
    thread_ = std::thread([this] {
      constexpr double kTurnSecs = 0.01;  // how soon the end is noticed
      while (!stop_) server_.work(kTurnSecs);
      server_.shutdown();
    });
  }
  ~ForgetfulMaster() {
    stop_ = true;
    thread_.join();
  }
  ForgetfulMaster(const ForgetfulMaster&) = delete;
  ForgetfulMaster& operator=(const ForgetfulMaster&) = delete;

  int restarts() const { return pid_ - kFirstPid; }
  Names Registered(const std::string& method) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = registered_.find(method);
    return found == registered_.end() ? Names() : found->second;
  }

 private:
  static constexpr int kFirstPid = 100;

  class Method : public XmlRpc::XmlRpcServerMethod {
   public:
    Method(const std::string& name, ForgetfulMaster& master)
        : XmlRpcServerMethod(name, &master.server_), master_(master) {}
    void execute(XmlRpcValue& arguments, XmlRpcValue& answer) override {
      answer[0] = 1;
      answer[1] = std::string();
      answer[2] = 0;
      master_.Answer(name(), arguments, answer);
    }

   private:
    ForgetfulMaster& master_;
  };

  void Answer(const std::string& method, XmlRpcValue& arguments, XmlRpcValue& answer) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const bool counts = method == fatal_method_ && arguments[1] == XmlRpcValue(fatal_topic_);
    if (counts && --calls_left_ == 0) {
      ++pid_;
      registered_.clear();
      node_uri_.clear();
    }
    if (method.rfind("register", 0) == 0) {
      registered_[method].insert(arguments[1]);
      node_uri_ = static_cast<std::string>(arguments[arguments.size() - 1]);
      if (method == "registerSubscriber") answer[2].setSize(0);  // its publishers
    } else if (method == "getPid") {
      answer[2] = pid_.load();
    } else if (method == "lookupNode" && !node_uri_.empty()) {
      answer[2] = node_uri_;
    } else if (method == "lookupNode" || method == "getParam") {
      answer[0] = -1;
    } else if (method == "hasParam") {
      answer[2] = XmlRpcValue(false);
    }
  }

  const std::string fatal_method_, fatal_topic_;
  std::atomic<bool> stop_{false};
  std::atomic<int> pid_{kFirstPid};
  mutable std::mutex mutex_;
  // Guarded by mutex_:
  int calls_left_;
  std::map<std::string, Names> registered_;  // by method
  std::string node_uri_;
  XmlRpc::XmlRpcServer server_;
  std::vector<std::unique_ptr<Method>> methods_;
  std::thread thread_;
};

const std::vector<std::string> kTopics = {"/kinescope/com", "/kinescope/joint_states",
                                          "/kinescope/markers", "/tf"};
const std::vector<std::string> kInputs = {"/kinescope/hand_wrench/right",
                                          "/kinescope/ground_wrench", "/kinescope/hand_load"};

TEST_F(RosBridgeWithMaster, RegistersEverythingAgainIfTheMasterRestartsDuringSubscribing) {
  const ForgetfulMaster master(port_.number(), "registerSubscriber", kInputs[1], 1);
  MakeBridge();
  EXPECT_TRUE(PublishUntil([&] { return bridge_->status().master_returns == 1; }));
  EXPECT_THAT(master.Registered("registerPublisher"), IsSupersetOf(kTopics));
  EXPECT_TRUE(PublishUntil([&] {
    return ::testing::Value(master.Registered("registerSubscriber"), IsSupersetOf(kInputs));
  }));
  EXPECT_EQ(master.restarts(), 1);
}

TEST_F(RosBridgeWithMaster, RegistersEverythingAgainIfTheMasterRestartsDuringAdvertising) {
  // roscpp has announced them already, and now it is said once more.
  const ForgetfulMaster master(port_.number(), "registerPublisher", kTopics[1], 2);
  MakeBridge();
  EXPECT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
  EXPECT_TRUE(PublishUntil([&] {
    return ::testing::Value(master.Registered("registerPublisher"), IsSupersetOf(kTopics)) &&
           ::testing::Value(master.Registered("registerSubscriber"), IsSupersetOf(kInputs));
  }));
  EXPECT_EQ(master.restarts(), 1);
}

}  // namespace
}  // namespace kinescope::ros_bridge
