// What a launch file started, seen from outside: the topics, TF and description of one person.
//   launch_test <node name>    started by rostest, see *.test beside this file
#include <geometry_msgs/Point.h>
#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>
#include <urdf/model.h>
#include <visualization_msgs/MarkerArray.h>
#include <xsens_mvn_ros_msgs/LinkStateArray.h>

#include <set>
#include <string>

namespace {

std::string g_node;  // set once by main

// The next message, or null with a failed expectation.
template <class Message>
boost::shared_ptr<const Message> Next(const std::string& topic) {
  auto message = ros::topic::waitForMessage<Message>(topic, ros::Duration(60));
  EXPECT_NE(message, nullptr) << "nothing comes on " << topic;
  return message;
}

TEST(LaunchFile, PublishesTheJointsOfThePerson) {
  const auto message = Next<sensor_msgs::JointState>(g_node + "/joint_states");
  ASSERT_NE(message, nullptr);
  EXPECT_EQ(message->position.size(), 66U);
  ASSERT_EQ(message->name.size(), 66U);
  EXPECT_EQ(message->name.front(), "skeleton_c1_head_x");
  EXPECT_EQ(message->name.back(), "skeleton_t9_t8_z");
}

TEST(LaunchFile, PublishesTheLinksOfThePerson) {
  const auto message = Next<xsens_mvn_ros_msgs::LinkStateArray>(g_node + "/link_states");
  ASSERT_NE(message, nullptr);
  ASSERT_EQ(message->states.size(), 23U);
  EXPECT_EQ(message->states.front().header.frame_id, "head");
  const double head = message->states.front().pose.position.z;
  EXPECT_GT(head, 0.3);
  EXPECT_LT(head, 2.5);
}

TEST(LaunchFile, PublishesCentresOfMassAndPressure) {
  const auto point = Next<geometry_msgs::Point>(g_node + "/com");
  ASSERT_NE(point, nullptr);
  EXPECT_GT(point->z, 0.2);
  const auto com = Next<geometry_msgs::PointStamped>(g_node + "/com_stamped");
  ASSERT_NE(com, nullptr);
  EXPECT_EQ(com->header.frame_id, "world");
  const auto cop = Next<geometry_msgs::PointStamped>(g_node + "/cop");
  ASSERT_NE(cop, nullptr);
  EXPECT_NEAR(cop->point.z, 0, 0.05);
}

TEST(LaunchFile, PublishesALoadSphereForEveryScoredJoint) {
  const auto message = Next<visualization_msgs::MarkerArray>(g_node + "/markers");
  ASSERT_NE(message, nullptr);
  int spheres = 0;
  for (const auto& marker : message->markers) spheres += marker.ns == "loads" ? 1 : 0;
  EXPECT_GE(spheres, 8);
}

TEST(LaunchFile, PublishesAFrameForEveryLinkOfTheDescription) {
  const auto message = Next<tf2_msgs::TFMessage>("/tf");
  ASSERT_NE(message, nullptr);
  std::set<std::string> frames;
  for (const auto& one : message->transforms) {
    EXPECT_EQ(one.header.frame_id, "world");
    frames.insert(one.child_frame_id);
  }
  std::string description;
  const auto deadline = ros::WallTime::now() + ros::WallDuration(60);
  while (!ros::param::get("robot_description", description)) {  // may come after the topics
    ASSERT_LT(ros::WallTime::now(), deadline) << "no robot_description";
  }
  urdf::Model model;
  ASSERT_TRUE(model.initString(description));
  EXPECT_EQ(model.getRoot()->name, "skeleton_pelvis");
  EXPECT_EQ(frames.size(), model.links_.size());
  for (const auto& [name, link] : model.links_) EXPECT_EQ(frames.count(name), 1U) << name;
}

}  // namespace

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "launch_test", ros::init_options::AnonymousName);
  if (argc != 2) return 2;
  g_node = argv[1];
  const ros::NodeHandle node;  // keeps roscpp up between the tests
  return RUN_ALL_TESTS();
}
