// Simulated time against a real master: each test runs in a process of its own (bridge_fixture.h).
#include <geometry_msgs/PointStamped.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/system/clocks.h"
#include "tests/server/ros/bridge_fixture.h"

namespace kinescope::ros_bridge {
namespace {

using testing::MakePerson;
using testing::Posture;
using testing::SceneWith;

class RosBridgeWithASimulator : public RosBridgeWithMaster {
 protected:
  void StartMasterWithSimulatedTime() {
    StartMaster();
    XmlRpc::XmlRpcValue arguments;
    arguments[0] = "/use_sim_time";
    arguments[1] = XmlRpc::XmlRpcValue(true);
    ASSERT_EQ(MasterClient().Call("setParam", arguments).code, MasterReply::Code::kGood);
  }

  // A node that says on /clock what time it is, and hears the stamps of the centre of mass.
  void StartSimulator() {
    ASSERT_TRUE(Within(kTestPatience, [&] {
      PublishSampleOfNow();
      return bridge_->status().missed > 0 && ros::isStarted() && ros::Time::isSimTime();
    }));
    node_.emplace();
    node_->setCallbackQueue(&queue_);
    clock_ = node_->advertise<rosgraph_msgs::Clock>("/clock", 10);
    const boost::function<void(const geometry_msgs::PointStamped::ConstPtr&)> keep =
        [this](const geometry_msgs::PointStamped::ConstPtr& message) {
          // roscpp may connect twice to a publisher that appears while a node subscribes to it.
          const bool is_twice =
              std::exchange(last_seq_, message->header.seq) == message->header.seq;
          if (!is_twice) stamps_.push_back(message->header.stamp.toSec());
        };
    com_ = node_->subscribe<geometry_msgs::PointStamped>("/kinescope/com_stamped", 0, keep);
  }
  void TearDown() override {
    com_.shutdown();
    clock_.shutdown();
    node_.reset();
    RosBridgeWithMaster::TearDown();
  }

  void PublishSampleOfNow() {
    sampled_nanos_ = WallNanos();
    PersonState person = MakePerson(model_, Posture(0), ++counter_, sampled_nanos_);
    person.com = Eigen::Vector3d(0, 0, 1);
    Publish(SceneWith(std::move(person)));
  }

  // The simulator's time begins at `start` and runs at half speed. Until `count` stamps were heard.
  std::vector<double> Run(double start, std::size_t count) {
    stamps_.clear();
    const std::int64_t began = MonotonicNanos();
    errors_.clear();
    EXPECT_TRUE(Within(kTestPatience, [&] {
      const double now = start + 0.5 * Secs(MonotonicNanos() - began);
      rosgraph_msgs::Clock tick;
      tick.clock = ros::Time(now);
      clock_.publish(tick);
      PublishSampleOfNow();
      const std::size_t known = stamps_.size();
      queue_.callAvailable();
      DropStampsBefore(start);
      for (std::size_t i = known; i < stamps_.size(); ++i) {
        errors_.push_back(std::abs(stamps_[i] - now));
      }
      return stamps_.size() >= count;
    }));
    return stamps_;
  }

  // The newest sample again, as the state of another person has it, while the clock goes on
  // unevenly from `start`.
  void RepeatSample(double start) {
    constexpr int kTimes = 60;
    PersonState person = MakePerson(model_, Posture(0), counter_, sampled_nanos_);
    person.com = Eigen::Vector3d(0, 0, 1);
    for (int i = 1; i <= kTimes; ++i) {
      rosgraph_msgs::Clock tick;
      tick.clock = ros::Time(start + 0.01 * i * i);
      clock_.publish(tick);
      EXPECT_TRUE(Within(kTestPatience, [&] { return ros::Time::now() >= tick.clock; }));
      Publish(SceneWith(person));
    }
  }

  // Of the last Run(), s. A busy machine makes some large.
  double MedianError() const {
    std::vector<double> errors = errors_;
    const auto middle = errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2);
    std::nth_element(errors.begin(), middle, errors.end());
    return *middle;
  }

 private:
  // What was still under way when the simulator started over.
  void DropStampsBefore(double start) {
    constexpr double kFar = 50;  // s
    const auto first = std::find_if(stamps_.begin(), stamps_.end(),
                                    [&](double stamp) { return std::abs(stamp - start) < kFar; });
    stamps_.erase(stamps_.begin(), first);
  }

  ros::CallbackQueue queue_;
  std::optional<ros::NodeHandle> node_;
  ros::Publisher clock_;
  ros::Subscriber com_;
  std::vector<double> stamps_, errors_;  // s
  std::int64_t sampled_nanos_ = 0;
  std::optional<std::uint32_t> last_seq_;
};

TEST_F(RosBridgeWithASimulator, StampsWithItsTimeAndFollowsItWhenItStartsOver) {
  StartMasterWithSimulatedTime();
  MakeBridge();
  StartSimulator();
  EXPECT_EQ(bridge_->status().published, 0U) << "nothing has said what time it is";
  for (const double start : {100.0, 3.0}) {
    const std::vector<double> stamps = Run(start, 60);
    EXPECT_LT(MedianError(), 0.1);
    EXPECT_GE(stamps.front(), start - 0.1);
    EXPECT_EQ(std::adjacent_find(stamps.begin(), stamps.end(), std::greater_equal<>()),
              stamps.end())
        << "tf2 drops what has the stamp of the transform before: "
        << ::testing::PrintToString(stamps);
  }
}

TEST_F(RosBridgeWithASimulator, PublishesASampleOnceAlsoWhenItsTimeIsKnownBetter) {
  StartMasterWithSimulatedTime();
  MakeBridge();
  StartSimulator();
  Run(100, 5);
  const std::uint64_t before = bridge_->status().published;
  RepeatSample(110);
  EXPECT_EQ(bridge_->status().published, before);
}

}  // namespace
}  // namespace kinescope::ros_bridge
