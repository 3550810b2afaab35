// ROS's own robot_state_publisher, fed with our URDF and our joint states, publishes our TF tree.
// Where the person is as rigid as the URDF, that is; how far people are from it:
// mechanism_test.cc.
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <urdf/model.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>

#include "tests/system/ros/ros_fixture.h"

namespace kinescope {
namespace {

using testing::Process;

struct Edge {
  std::string parent;
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
};
using Tree = std::map<std::string, Edge>;  // by child frame

class RobotStatePublisher : public testing::RosProgram {
 protected:
  // Compares both trees of `stamps` samples. `frames`: that each has below the pelvis.
  void ExpectSameTrees(std::size_t frames, int stamps) {
    ASSERT_TRUE(WaitForDescription(frames)) << "no URDF of " << frames << " joints";
    const Process publisher({KINESCOPE_ROBOT_STATE_PUBLISHER, "__name:=robot_state_publisher",
                             "joint_states:=/kinescope/joint_states", "/tf:=/theirs/tf",
                             "/tf_static:=/theirs/tf_static", "_publish_frequency:=1000"});
    Hear<tf2_msgs::TFMessage>("/tf", [&](const auto& message) { Keep(message, ours_); });
    Hear<tf2_msgs::TFMessage>("/theirs/tf", [&](const auto& message) { Keep(message, theirs_); });
    Hear<tf2_msgs::TFMessage>("/theirs/tf_static", [&](const auto& message) {
      static_frames_ += message.transforms.size();
    });
    EXPECT_TRUE(Spin([&] { return Compare(frames) >= stamps; }))
        << compared_ << " of " << stamps << " samples came both ways; waiting: " << ours_.size()
        << " of ours, " << theirs_.size() << " of theirs";
    EXPECT_EQ(static_frames_, 0U) << "nothing in a person is fixed";
    EXPECT_LT(worst_metres_, 1e-6);
    EXPECT_LT(worst_radians_, 1e-6);
    fmt::print("{} samples of {} frames; worst {:.1e} m, {:.1e} rad\n", compared_, frames,
               worst_metres_, worst_radians_);
  }

 private:
  bool WaitForDescription(std::size_t joints) {
    return Spin([&] {
      std::string description;
      ::urdf::Model model;
      return ros::param::get("/robot_description", description) && model.initString(description) &&
             model.joints_.size() == joints;
    });
  }

  static void Keep(const tf2_msgs::TFMessage& message, std::map<ros::Time, Tree>& trees) {
    for (const auto& one : message.transforms) {
      const auto& t = one.transform.translation;
      const auto& r = one.transform.rotation;
      trees[one.header.stamp][one.child_frame_id] = {
          one.header.frame_id, {t.x, t.y, t.z}, {r.w, r.x, r.y, r.z}};
    }
  }

  int Compare(std::size_t frames) {
    while (!theirs_.empty()) {
      const auto [stamp, theirs] = *theirs_.begin();
      const auto ours = ours_.find(stamp);
      const bool is_passed = !ours_.empty() && ours_.rbegin()->first > stamp;
      if (ours == ours_.end() && !is_passed) break;  // still under way
      if (ours != ours_.end()) CompareOne(ours->second, theirs, frames);
      ours_.erase(ours_.begin(), ours_.upper_bound(stamp));
      theirs_.erase(theirs_.begin());
    }
    return compared_;
  }

  void CompareOne(const Tree& ours, const Tree& theirs, std::size_t frames) {
    EXPECT_EQ(theirs.size(), frames);
    for (const auto& [frame, edge] : theirs) {
      const auto same = ours.find(frame);
      if (same == ours.end()) {
        ADD_FAILURE() << frame << " is not in our tree";
        continue;
      }
      EXPECT_EQ(same->second.parent, edge.parent) << frame;
      const double metres = (same->second.translation - edge.translation).norm();
      const double radians = 2 * (same->second.rotation.conjugate() * edge.rotation).vec().norm();
      EXPECT_LT(metres, 1e-6) << frame;
      EXPECT_LT(radians, 1e-6) << frame;
      worst_metres_ = std::max(worst_metres_, metres);
      worst_radians_ = std::max(worst_radians_, radians);
    }
    ++compared_;
  }

  std::map<ros::Time, Tree> ours_, theirs_;
  std::size_t static_frames_ = 0;
  int compared_ = 0;
  double worst_metres_ = 0, worst_radians_ = 0;
};

TEST_F(RobotStatePublisher, PublishesTheSameTreeAsKinescope) {
  const auto bridge = Start("bridge demo:lift --tf tree --ros required");
  ExpectSameTrees(66, 200);
}

TEST_F(RobotStatePublisher, PublishesTheSameTreeForStreamedGlovesAndProps) {
  const auto bridge = Start("bridge udp://127.0.0.1:0 --tf tree --ros required");
  const std::string suit_address = WaitForAddress(*bridge);
  const auto suit = Start(fmt::format("stream demo:lift --gloves --props 2 --to {}", suit_address));
  ExpectSameTrees(66 + 120 + 12, 100);
}

TEST_F(RobotStatePublisher, MakesTheRestOfATreeThatBeginsWithThePelvis) {
  const auto bridge = Start("bridge demo:lift --tf off --ros required");
  WaitForParameter("/robot_description");
  const Process publisher({KINESCOPE_ROBOT_STATE_PUBLISHER, "__name:=robot_state_publisher",
                           "joint_states:=/kinescope/joint_states"});
  Tree tree;
  Hear<tf2_msgs::TFMessage>("/tf", [&](const auto& message) {
    for (const auto& one : message.transforms) {
      EXPECT_TRUE(tree.count(one.child_frame_id) == 0 ||
                  tree[one.child_frame_id].parent == one.header.frame_id)
          << one.child_frame_id << " has two parents";
      tree[one.child_frame_id].parent = one.header.frame_id;
    }
  });
  EXPECT_TRUE(Spin([&] {
    std::string frame = "skeleton_right_hand";
    while (tree.count(frame) != 0) frame = tree[frame].parent;
    return frame == "world";
  }));
}

}  // namespace
}  // namespace kinescope
