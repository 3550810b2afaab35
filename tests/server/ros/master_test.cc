// Topics against a real master: each test runs in a process of its own (bridge_fixture.h).
#include <gtest/gtest.h>
#include <ros/node_handle.h>
#include <ros/service.h>
#include <ros/spinner.h>
#include <ros/xmlrpc_manager.h>
#include <signal.h>
#include <visualization_msgs/MarkerArray.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>

#include "tests/server/ros/bridge_fixture.h"

namespace kinescope::ros_bridge {
namespace {

using testing::MakePerson;
using testing::Posture;
using testing::SceneWith;

// Publishing waits for the lock of a connection at most; a wait for a master has no end, or one of
// seconds.
constexpr double kLongestWaitMillis = 500;

// What comes on one topic of markers, in this process.
class MarkerLog {
 public:
  explicit MarkerLog(const std::string& topic) : spinner_(1) {
    const boost::function<void(const visualization_msgs::MarkerArray::ConstPtr&)> keep =
        [this](const visualization_msgs::MarkerArray::ConstPtr& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          arrays_.push_back(*message);
          came_.notify_all();
        };
    subscriber_ = node_.subscribe<visualization_msgs::MarkerArray>(topic, 0, keep);
    spinner_.start();
  }

  // The first `count`, or however many came in time.
  std::vector<visualization_msgs::MarkerArray> WaitFor(std::size_t count) {
    std::unique_lock<std::mutex> lock(mutex_);
    came_.wait_for(lock, kTestPatience, [&] { return arrays_.size() >= count; });
    return arrays_;
  }

 private:
  std::mutex mutex_;
  std::condition_variable came_;
  std::vector<visualization_msgs::MarkerArray> arrays_;  // guarded by mutex_
  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_;
};

TEST_F(RosBridgeWithMaster, DeliversEverySampleAt240HzExactlyOnceOnEveryTopic) {
  StartMaster();
  MakeBridge();
  const auto listener = Listen();
  ExpectEveryOneOnce(*listener, 500);
  EXPECT_LT(longest_wait_millis_, kLongestWaitMillis);
  RecordProperty("longest_wait_ms", std::to_string(longest_wait_millis_));
}

TEST_F(RosBridgeWithMaster, DeliversABurstCompletely) {
  StartMaster();
  MakeBridge();
  const auto listener = Listen();
  ExpectEveryOneOnce(*listener, 400, Description::kThere, Pace::kBurst);
}

TEST_F(RosBridgeWithMaster, RunsWithoutAMasterAndRegistersWhenOneStarts) {
  EXPECT_FALSE(MasterIsReachable());
  MakeBridge();
  for (int i = 0; i < 20; ++i) PublishNext();
  EXPECT_EQ(bridge_->status().missed, 20U);
  EXPECT_EQ(bridge_->status().published, 0U);
  EXPECT_FALSE(bridge_->status().master_reachable);
  StartMaster();
  const auto listener = Listen();
  ExpectEveryOneOnce(*listener, 50);
  EXPECT_EQ(bridge_->status().published + bridge_->status().missed, counter_);
  EXPECT_EQ(bridge_->status().master_returns, 0U);
}

TEST_F(RosBridgeWithMaster, SurvivesARestartOfTheMaster) {
  StartMaster();
  MakeBridge();
  const auto early = Listen();
  KillMaster();
  ASSERT_TRUE(PublishUntil([&] { return !bridge_->status().master_reachable; }));
  ASSERT_NO_FATAL_FAILURE(ExpectEveryOneOnce(*early, 50, Description::kNone))
      << "who is connected needs no master";
  StartMaster();
  ASSERT_TRUE(PublishUntil([&] { return bridge_->status().master_returns == 1; }));
  EXPECT_TRUE(bridge_->status().master_reachable);
  const auto late = Listen();  // only the new master can have told it where we are
  ExpectEveryOneOnce(*late, 50);
  EXPECT_LT(longest_wait_millis_, kLongestWaitMillis);
  RecordProperty("longest_wait_ms", std::to_string(longest_wait_millis_));
}

TEST_F(RosBridgeWithMaster, IsNotDelayedByAMasterThatNeverAnswers) {
  StartMaster();
  MakeBridge();
  const auto listener = Listen();
  master_->Signal(SIGSTOP);
  ASSERT_TRUE(PublishUntil([&] { return !bridge_->status().master_reachable; }));
  EXPECT_EQ(bridge_->status().missed + bridge_->status().published, counter_);
  master_->Signal(SIGCONT);
  ASSERT_TRUE(PublishUntil([&] { return bridge_->status().master_reachable; }));
  ExpectEveryOneOnce(*listener, 50);
  EXPECT_EQ(bridge_->status().master_returns, 0U) << "it was never away";
  EXPECT_LT(longest_wait_millis_, kLongestWaitMillis);
}

TEST_F(RosBridgeWithMaster, EndsSoonIfTheMasterDoesNotAnswer) {
  StartMaster();
  MakeBridge();
  // Whatever roscpp registers by itself, without a time limit, is registered: the service comes
  // last.
  ASSERT_TRUE(PublishUntil([&] {
    return bridge_->status().published > 0 &&
           ros::service::exists("/kinescope/set_hand_load", false);
  }));
  master_->Signal(SIGSTOP);
  const auto before = Clock::now();
  bridge_.reset();
  EXPECT_LT(Clock::now() - before, kTestPatience) << "2.5 s, on an idle machine";
}

TEST_F(RosBridgeWithMaster, PublishesEachLiveSampleOnceAndNoStaleOnes) {
  StartMaster();
  MakeBridge();
  ASSERT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
  const std::uint64_t before = bridge_->status().published;
  SceneState state = SceneWith(MakePerson(model_, Posture(0), 77, kEpochNanos));
  Publish(state);
  Publish(state);
  EXPECT_EQ(bridge_->status().published, before + 1);
  state.people[0].sample.counter = 78;
  state.liveness = Liveness::kStale;
  Publish(state);
  EXPECT_EQ(bridge_->status().published, before + 1);
  state.liveness = Liveness::kLive;
  Publish(state);
  EXPECT_EQ(bridge_->status().published, before + 2);
}

TEST_F(RosBridgeWithMaster, TurnsTheMarkersGreyOnceWhenTheStreamStops) {
  StartMaster();
  MakeBridge();
  ASSERT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));

  MarkerLog log("/kinescope/markers");
  PublishNext();
  SceneState stale;
  stale.liveness = Liveness::kStale;  // nobody is in it any more
  Publish(stale);
  Publish(stale);
  PublishNext();
  const auto arrays = log.WaitFor(3);
  ASSERT_EQ(arrays.size(), 3U) << "live, stale once, live";
  EXPECT_GT(arrays[0].markers[0].lifetime.toSec(), 0);
  for (const auto& marker : arrays[1].markers) {
    EXPECT_EQ(marker.lifetime.toSec(), 0) << "a stale marker stays: " << marker.ns;
    const double spread = std::max({marker.color.r, marker.color.g, marker.color.b}) -
                          std::min({marker.color.r, marker.color.g, marker.color.b});
    EXPECT_LT(spread, 0.1) << "a stale marker has no colour: " << marker.ns;
  }
  EXPECT_EQ(arrays[0].markers.size(), arrays[1].markers.size());
  EXPECT_GT(arrays[2].markers[0].lifetime.toSec(), 0);
}

TEST_F(RosBridgeWithMaster, PublishesNoGreyMarkersOfAPersonWhoLeftBefore) {
  StartMaster();
  MakeBridge();
  ASSERT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
  MarkerLog log("/kinescope/markers");
  PublishNext();
  SceneState other = SceneWith(MakePerson(model_, Posture(0), ++counter_, StampNow()));
  other.people[0].character = 1;
  Publish(other);  // the first person is not in it any more
  SceneState stale;
  stale.liveness = Liveness::kStale;
  Publish(stale);
  PublishNext();
  const auto arrays = log.WaitFor(2);
  ASSERT_EQ(arrays.size(), 2U);
  for (const auto& array : arrays) EXPECT_GT(array.markers.at(0).lifetime.toSec(), 0);
}

TEST_F(RosBridgeWithMaster, ReportsAShutdownThroughRos) {
  StartMaster();
  MakeBridge();
  ASSERT_TRUE(PublishUntil([&] { return bridge_->status().published > 0; }));
  const auto& manager = ros::XMLRPCManager::instance();
  XmlRpc::XmlRpcClient ours("127.0.0.1", static_cast<int>(manager->getServerPort()), "/");
  XmlRpc::XmlRpcValue arguments;
  XmlRpc::XmlRpcValue response;
  arguments[0] = "/rosnode";
  arguments[1] = "user request";
  ASSERT_TRUE(ours.execute("shutdown", arguments, response));
  EXPECT_TRUE(PublishUntil([&] { return bridge_->status().shutdown_requested; }));
}

}  // namespace
}  // namespace kinescope::ros_bridge
