// The method kinescope_time, between real XML-RPC servers: each test runs in a process of its own
// (bridge_fixture.h).
#include "server/ros/node_time.h"

#include <gtest/gtest.h>
#include <ros/this_node.h>
#include <xmlrpcpp/XmlRpcServer.h>
#include <xmlrpcpp/XmlRpcServerMethod.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "server/ros/xmlrpc_limits.h"
#include "tests/server/ros/bridge_fixture.h"

namespace kinescope::ros_bridge {
namespace {

using XmlRpc::XmlRpcValue;

TEST_F(RosBridgeWithMaster, AnswersWithItsNameAndTime) {
  StartMaster();
  MakeBridge();
  NodeTimes times;
  const std::int64_t wall = WallNanos(), monotonic = MonotonicNanos();
  times.SetNodes({ros::this_node::getName()});
  std::vector<std::pair<std::string, RoundTrip>> answers;
  ASSERT_TRUE(PublishUntil([&] { return !(answers = times.Take()).empty(); }));
  EXPECT_EQ(answers[0].first, ros::this_node::getName());
  const RoundTrip& trip = answers[0].second;
  EXPECT_GE(trip.theirs, wall);
  EXPECT_LE(trip.theirs, WallNanos());
  EXPECT_GE(trip.sent, monotonic);
  EXPECT_GT(trip.received, trip.sent);
  EXPECT_LE(trip.received, MonotonicNanos());
  EXPECT_EQ(times.failures(), 0U);
}

// Master and nodes at once: every node is here, and answers as the test wants.
class Graph {
 public:
  Graph(int port, std::function<void(XmlRpcValue&)> time)
      : lookup_("lookupNode", server_,
                [port](XmlRpcValue& result) {
                  result = "http://127.0.0.1:" + std::to_string(port) + "/";
                }),
        time_("kinescope_time", server_, std::move(time)) {
    EXPECT_TRUE(server_.bindAndListen(port));
    thread_ = std::thread([this] {
      constexpr double kTurnSecs = 0.01;  // how soon the end is noticed
      while (!stop_) server_.work(kTurnSecs);
      server_.shutdown();
    });
  }
  ~Graph() {
    stop_ = true;
    thread_.join();
  }
  Graph(const Graph&) = delete;
  Graph& operator=(const Graph&) = delete;

 private:
  class Method : public XmlRpc::XmlRpcServerMethod {
   public:
    Method(const std::string& name, XmlRpc::XmlRpcServer& server,
           std::function<void(XmlRpcValue&)> fill)
        : XmlRpcServerMethod(name, &server), fill_(std::move(fill)) {}
    void execute(XmlRpcValue&, XmlRpcValue& answer) override {
      answer[0] = 1;
      answer[1] = std::string();
      fill_(answer[2]);
    }

   private:
    const std::function<void(XmlRpcValue&)> fill_;
  };

  std::atomic<bool> stop_{false};
  XmlRpc::XmlRpcServer server_;
  Method lookup_, time_;
  std::thread thread_;
};

TEST_F(RosBridgeWithMaster, SurvivesNodesThatAnswerWithSomethingElseThanATime) {
  std::atomic<int> asked{0};
  const Graph graph(port_.number(), [&](XmlRpcValue& value) {
    constexpr int kCallsPerQuestion = 2;  // the first one connects
    switch (asked++ / kCallsPerQuestion) {
      case 0: value = 7; break;
      case 1: value.setSize(0); break;
      case 2: value[0] = "/c", value[1] = 7; break;
      case 3: value[0] = "/d", value[1] = "7 o'clock"; break;
      case 4: value[0] = "/another", value[1] = "1700000000000000000"; break;
      default: value[0] = "/f", value[1] = "1700000000000000000"; break;
    }
  });
  NodeTimes times;
  times.SetNodes({"/a", "/b", "/c", "/d", "/e", "/f"});
  std::vector<std::pair<std::string, RoundTrip>> answers;
  ASSERT_TRUE(Within(kTestPatience, [&] { return !(answers = times.Take()).empty(); }));
  EXPECT_EQ(answers[0].first, "/f");
  EXPECT_EQ(answers[0].second.theirs, 1'700'000'000'000'000'000);
  EXPECT_EQ(times.failures(), 3U) << "/b, /d and /e";
  const auto rejected = RejectedXmlRpc();  // of all nodes, by master_answers.h
  for (const char* other : {"an int", "an array of other values"}) {
    EXPECT_EQ(rejected.count("answered kinescope_time with " + std::string(other) +
                             " instead of an array of strings"),
              1U);
  }
}

}  // namespace
}  // namespace kinescope::ros_bridge
