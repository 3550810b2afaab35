#include "server/ros/link_states.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "server/ros/names.h"
#include "server/ros/stamp.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;

TEST(LinkStates, HaveTheTypeNamesAndMd5SumsOfXsensMvnRos) {
  namespace traits = ros::message_traits;
  using xsens_mvn_ros_msgs::LinkState;
  using xsens_mvn_ros_msgs::LinkStateArray;
  EXPECT_STREQ(traits::DataType<LinkState>::value(), "xsens_mvn_ros_msgs/LinkState");
  EXPECT_STREQ(traits::MD5Sum<LinkState>::value(), "f66648d1c57928da53a1cb39d1189cb5");
  EXPECT_STREQ(traits::DataType<LinkStateArray>::value(), "xsens_mvn_ros_msgs/LinkStateArray");
  EXPECT_STREQ(traits::MD5Sum<LinkStateArray>::value(), "60e3b550b31b607e6e37f091193f9981");
}

TEST(LinkStates, ContainEveryLinkByItsBareNameInAlphabeticalOrder) {
  const auto person = testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 1'000);
  xsens_mvn_ros_msgs::LinkStateArray message;
  FillLinkStates(person, "lab", message);
  EXPECT_EQ(message.header.frame_id, "lab");
  std::vector<std::string> names;
  for (const auto& state : message.states) names.push_back(state.header.frame_id);
  EXPECT_THAT(names, ElementsAre("head", "l3", "l5", "left_foot", "left_forearm", "left_hand",
                                 "left_lower_leg", "left_shoulder", "left_toe", "left_upper_arm",
                                 "left_upper_leg", "neck", "pelvis", "right_foot", "right_forearm",
                                 "right_hand", "right_lower_leg", "right_shoulder", "right_toe",
                                 "right_upper_arm", "right_upper_leg", "t12", "t8"));
}

TEST(LinkStates, ContainThePoseOfTheLinkAndTheMeasuredMotion) {
  const auto person = testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 1'000);
  xsens_mvn_ros_msgs::LinkStateArray message;
  FillLinkStates(person, "world", message);
  const auto& hand = message.states[15];
  ASSERT_EQ(hand.header.frame_id, "right_hand");
  const auto segment = static_cast<std::size_t>(urdf::kRightHand);
  const urdf::Pose& pose = person.links[segment];
  EXPECT_EQ(Eigen::Vector3d(hand.pose.position.x, hand.pose.position.y, hand.pose.position.z),
            pose.position);
  const Eigen::Quaterniond orientation(hand.pose.orientation.w, hand.pose.orientation.x,
                                       hand.pose.orientation.y, hand.pose.orientation.z);
  EXPECT_EQ(orientation.coeffs(), pose.orientation.coeffs());
  const SegmentState& measured = person.sample.segments[segment];
  EXPECT_EQ(hand.twist.linear.x, measured.velocity.x());
  EXPECT_EQ(hand.twist.angular.z, measured.angular_velocity.z());
  EXPECT_EQ(hand.accel.linear.y, measured.acceleration.y());
  EXPECT_EQ(hand.accel.angular.x, measured.angular_acceleration.x());
}

TEST(LinkStates, HaveOneTimeStamp) {
  const std::int64_t stamp = 1'700'000'000'123'456'789;
  const auto person = testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, stamp);
  xsens_mvn_ros_msgs::LinkStateArray message;
  FillLinkStates(person, "world", message);
  EXPECT_EQ(message.header.stamp, ros::Time(1'700'000'000, 123'456'789));
  for (const auto& state : message.states) EXPECT_EQ(state.header.stamp, message.header.stamp);
  geometry_msgs::PointStamped point;
  FillPoint(person, "world", *person.com, point);
  EXPECT_EQ(point.header.stamp, message.header.stamp);
  EXPECT_EQ(point.header.frame_id, "world");
  EXPECT_EQ(point.point.z, person.com->z());
}

TEST(Stamp, IsLimitedToTheRangeOfRosTime) {
  BodySample sample;
  sample.stamp_nanos = std::numeric_limits<std::int64_t>::min();
  EXPECT_EQ(StampOf(sample), ros::Time(0, 0));
  sample.stamp_nanos = std::numeric_limits<std::int64_t>::max();
  EXPECT_EQ(StampOf(sample), ros::Time(std::numeric_limits<std::uint32_t>::max(), 999'999'999));
}

}  // namespace
}  // namespace kinescope::ros_bridge
