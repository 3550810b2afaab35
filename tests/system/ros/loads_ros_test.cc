// Loads over ROS with everything real: a master, `kinescope bridge`, this test as the plate, the
// other program and the one who says what is held.
#include <fmt/format.h>
#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <gtest/gtest.h>
#include <kinescope/HandLoad.h>
#include <kinescope/JointLoadArray.h>
#include <kinescope/SetHandLoad.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <kdl/tree.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <map>
#include <optional>
#include <set>

#include "tests/system/ros/ros_fixture.h"
#include "urdf/segments.h"

namespace kinescope {
namespace {

class LoadsOverRos : public testing::RosProgram {
 protected:
  static constexpr std::int32_t kPatienceMillis = std::chrono::milliseconds(kPatience).count();

  void StartBridge(const std::string& source) {
    program_ = Start("bridge --ros required --mass 70 --source " + source);
    Hear<kinescope_ros::JointLoadArray>("/kinescope/joint_loads",
                                        [this](const auto& m) { loads_ = m; });
    Hear<sensor_msgs::JointState>("/kinescope/joint_states",
                                  [this](const auto& m) { joints_ = m; });
    ASSERT_TRUE(Spin([&] { return loads_ && joints_; })) << "nothing is published";
  }

  const kinescope_ros::JointLoad& LoadOf(const std::string& joint) const {
    for (const kinescope_ros::JointLoad& load : loads_->loads) {
      if (load.joint == joint) return load;
    }
    throw std::out_of_range(joint);
  }

  template <class Message>
  ros::Publisher Advertise(const std::string& topic) {
    ros::Publisher publisher = node_->advertise<Message>(topic, 10);
    EXPECT_TRUE(Spin([&] { return publisher.getNumSubscribers() > 0; })) << topic;
    return publisher;
  }

  // Publishes what `make` gives for each new sample until `condition` holds.
  template <class Make, class Condition>
  bool Answer(ros::Publisher& publisher, const Make& make, const Condition& condition) {
    ros::Time answered;
    return Spin([&] {
      if (loads_->header.stamp != answered) {
        answered = loads_->header.stamp;
        publisher.publish(make());
      }
      return condition();
    });
  }

  std::unique_ptr<testing::Process> program_;
  std::optional<kinescope_ros::JointLoadArray> loads_;
  std::optional<sensor_msgs::JointState> joints_;
};

TEST_F(LoadsOverRos, MatchKdlNewtonEulerEffortsOnThePublishedUrdf) {
  std::optional<tf2_msgs::TFMessage> frames;
  Hear<tf2_msgs::TFMessage>("/tf", [&](const auto& m) { frames = m; });
  StartBridge("demo:t_pose");
  ASSERT_TRUE(Spin(
      [&] { return frames && frames->transforms.at(0).header.stamp == joints_->header.stamp; }));
  KDL::Tree tree;
  ASSERT_TRUE(kdl_parser::treeFromString(WaitForParameter("/robot_description"), tree));
  KDL::Vector down(0, 0, -9.81);
  for (const auto& frame : frames->transforms) {
    if (frame.child_frame_id != "skeleton_pelvis") continue;
    const auto& q = frame.transform.rotation;
    down = KDL::Rotation::Quaternion(q.x, q.y, q.z, q.w).Inverse() * down;
  }
  std::map<std::string, std::size_t> row;
  for (std::size_t i = 0; i < joints_->name.size(); ++i) row[joints_->name[i]] = i;
  ASSERT_EQ(joints_->effort.size(), joints_->name.size());
  const unsigned count = tree.getNrOfJoints();
  KDL::JntArray angles(count), still(count), torques(count);
  for (const auto& [link, element] : tree.getSegments()) {
    const KDL::Joint& joint = element.segment.getJoint();
    if (joint.getType() == KDL::Joint::None) continue;
    angles(element.q_nr) = joints_->position.at(row.at(joint.getName()));
  }
  KDL::TreeIdSolver_RNE solver(tree, down);
  ASSERT_EQ(solver.CartToJnt(angles, still, still, KDL::WrenchMap(), torques), 0);
  int compared = 0;
  for (const auto& [link, element] : tree.getSegments()) {
    const KDL::Joint& joint = element.segment.getJoint();
    if (joint.getType() == KDL::Joint::None) continue;
    const std::string& name = joint.getName();
    const bool is_leg =
        name.find("hip") != std::string::npos || name.find("knee") != std::string::npos ||
        name.find("ankle") != std::string::npos || name.find("foot") != std::string::npos;
    if (is_leg) continue;  // KDL knows no floor under the feet
    const double theirs = torques(element.q_nr);
    EXPECT_NEAR(joints_->effort[row.at(name)], theirs, 1e-3 * std::max(1.0, std::abs(theirs)))
        << name;
    ++compared;
  }
  EXPECT_EQ(compared, 42);
}

TEST_F(LoadsOverRos, UseAMeasuredGroundReactionForceUntilItExpires) {
  StartBridge("demo:n_pose");
  ASSERT_TRUE(Spin([&] { return std::isfinite(loads_->cop.x); }));
  EXPECT_FALSE(loads_->cop_measured);
  const geometry_msgs::Point computed = loads_->cop;
  // A plate that only /tf knows, turned over as plates are mounted.
  ros::Publisher tf_static = node_->advertise<tf2_msgs::TFMessage>("/tf_static", 1, true);
  tf2_msgs::TFMessage mounting;
  mounting.transforms.resize(1);
  mounting.transforms[0].header.frame_id = "world";
  mounting.transforms[0].child_frame_id = "plate";
  mounting.transforms[0].transform.translation.x = 1;
  mounting.transforms[0].transform.rotation.x = 1;  // half a turn: z down
  tf_static.publish(mounting);
  ros::Publisher plate = Advertise<geometry_msgs::WrenchStamped>("/kinescope/ground_wrench");
  const double weight = loads_->body_mass * 9.81, shifted = computed.x + 0.03;
  const auto measure = [&] {
    geometry_msgs::WrenchStamped wrench;
    wrench.header.stamp = loads_->header.stamp;
    wrench.header.frame_id = "plate";
    wrench.wrench.force.z = -weight;  // the plate's z points down
    // In the world, about the plate's origin at x = 1: M = r x F = (y Fz, -(x - 1) Fz, 0).
    wrench.wrench.torque.x = computed.y * weight;
    wrench.wrench.torque.y = (shifted - 1) * weight;  // y is turned over too
    return wrench;
  };
  ASSERT_TRUE(Answer(plate, measure, [&] { return loads_->cop_measured; }));
  EXPECT_NEAR(loads_->cop.x, shifted, 1e-3);
  EXPECT_NEAR(loads_->cop.y, computed.y, 1e-3);
  ASSERT_TRUE(Spin([&] { return !loads_->cop_measured; })) << "the plate stopped";
  EXPECT_NEAR(loads_->cop.x, computed.x, 2e-3);
}

TEST_F(LoadsOverRos, UseExternalLoadsPerJointWhileTheyArrive) {
  StartBridge("demo:n_pose");
  ros::Publisher other = Advertise<sensor_msgs::JointState>("/kinescope/external_joint_states");
  const auto say = [&] {
    sensor_msgs::JointState message;
    message.header.stamp = loads_->header.stamp;
    message.name = {"jRightElbow_rotx", "jRightElbow_roty", "jRightElbow_rotz", "somebody_elses"};
    message.effort = {0, 0, -70, 1};  // the arm lies along y there: it bends about z
    return message;
  };
  ASSERT_TRUE(Answer(other, say, [&] {
    return LoadOf("jRightElbow").load_class == kinescope_ros::JointLoad::HIGH;
  }));
  EXPECT_EQ(LoadOf("jRightElbow").source, kinescope_ros::JointLoad::EXTERNAL);
  EXPECT_EQ(LoadOf("jLeftElbow").source, kinescope_ros::JointLoad::COMPUTED);
  ASSERT_TRUE(
      Spin([&] { return LoadOf("jRightElbow").source == kinescope_ros::JointLoad::COMPUTED; }));
  ASSERT_TRUE(
      Spin([&] { return LoadOf("jRightElbow").load_class == kinescope_ros::JointLoad::LOW; }));
}

TEST_F(LoadsOverRos, AcceptHandLoadsByServiceAndByTopic) {
  std::set<std::string> held;
  Hear<visualization_msgs::MarkerArray>("/kinescope/markers", [&](const auto& message) {
    for (const auto& marker : message.markers) held.insert(marker.ns);
  });
  StartBridge("demo:t_pose");
  ASSERT_TRUE(
      Spin([&] { return LoadOf("jRightShoulder").load_class == kinescope_ros::JointLoad::LOW; }));
  EXPECT_EQ(held.count("hand_loads"), 0u);
  kinescope_ros::SetHandLoad order;
  order.request.right_kg = 500;
  ASSERT_TRUE(ros::service::waitForService("/kinescope/set_hand_load", kPatienceMillis));
  ASSERT_TRUE(ros::service::call("/kinescope/set_hand_load", order));
  EXPECT_FALSE(order.response.success);
  EXPECT_NE(order.response.message.find("500"), std::string::npos) << order.response.message;
  order.request.right_kg = 2;
  ASSERT_TRUE(ros::service::call("/kinescope/set_hand_load", order));
  EXPECT_TRUE(order.response.success) << order.response.message;
  ASSERT_TRUE(Spin([&] { return loads_->held_mass[0] == 2; }));  // after its ramp
  ASSERT_TRUE(Spin(
      [&] { return LoadOf("jRightShoulder").load_class == kinescope_ros::JointLoad::MEDIUM; }));
  EXPECT_EQ(LoadOf("jLeftShoulder").load_class, kinescope_ros::JointLoad::LOW);
  // The same mass farther out is a larger moment.
  const double at_the_grip = LoadOf("jRightShoulder").ratio;
  order.request.right_com = {0, 0, -0.4};
  ASSERT_TRUE(ros::service::call("/kinescope/set_hand_load", order));
  ASSERT_TRUE(Spin([&] { return LoadOf("jRightShoulder").ratio > 1.2 * at_the_grip; }));
  order.request.right_com = {0, 0};
  ASSERT_TRUE(ros::service::call("/kinescope/set_hand_load", order));
  EXPECT_FALSE(order.response.success);
  ASSERT_TRUE(Spin([&] { return held.count("hand_loads") == 1; }));
  EXPECT_EQ(held.count("support"), 1u);
  EXPECT_EQ(held.count("foot_forces"), 1u);
  ros::Publisher hands = Advertise<kinescope_ros::HandLoad>("/kinescope/hand_load");
  hands.publish(kinescope_ros::HandLoad());
  ASSERT_TRUE(Spin([&] { return loads_->held_mass[0] == 0; }));
  EXPECT_EQ(WaitForLine(*program_, "ros changed hand load of Demo: "), "unknown → 2 kg right");
}

TEST_F(LoadsOverRos, ReceiveInputsAgainAfterARestartOfTheMaster) {
  StartBridge("demo:t_pose");
  master_.reset();
  StartMaster();
  ASSERT_TRUE(ros::service::waitForService("/kinescope/set_hand_load", kPatienceMillis));
  kinescope_ros::SetHandLoad order;
  order.request.left_kg = 3;
  ASSERT_TRUE(ros::service::call("/kinescope/set_hand_load", order));
  ASSERT_TRUE(Spin([&] { return loads_->held_mass[1] == 3; }));
  ros::Publisher hands = Advertise<kinescope_ros::HandLoad>("/kinescope/hand_load");
  hands.publish(kinescope_ros::HandLoad());
  ASSERT_TRUE(Spin([&] { return loads_->held_mass[1] == 0; }));
}

}  // namespace
}  // namespace kinescope
