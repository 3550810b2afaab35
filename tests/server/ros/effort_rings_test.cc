// Efforts of joints as rings about them: as large and as red as the effort, only about joints that
// turn.
#include "server/ros/effort_rings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>

namespace kinescope::ros_bridge {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;
using urdf::RobotJoint;
using visualization_msgs::Marker;

RobotJoint JointAbout(const Eigen::Vector3d& axis, double most) {
  RobotJoint joint;
  joint.name = "lift";
  joint.type = RobotJoint::Type::kRevolute;
  joint.axis = axis;
  joint.limits = urdf::JointLimits{-1, 1, most, 1};
  return joint;
}

sensor_msgs::JointState StateOf(double effort) {
  sensor_msgs::JointState state;
  state.name = {"lift"};
  state.effort = {effort};
  return state;
}

// Of one joint, which is the third one.
Taken<ShownMarkers> Show(const RobotJoint& joint, const sensor_msgs::JointState& state,
                         const ShownStyle& style = {}) {
  return ToMarkers(
      state,
      [&](const std::string& name) -> std::optional<ShownJoint> {
        if (name != joint.name) return std::nullopt;
        return ShownJoint{2, std::make_shared<RobotJoint>(joint), "arm/hand"};
      },
      style);
}

Eigen::Vector3d At(const Marker& marker, std::size_t i) {
  return {marker.points[i].x, marker.points[i].y, marker.points[i].z};
}

TEST(EffortRings, GoWithTheFrameOfTheLinkThatTurns) {
  const auto markers = Show(JointAbout({0, 0, 1}, 10), StateOf(5));
  ASSERT_TRUE(markers);
  ASSERT_THAT(*markers, SizeIs(2));
  for (const Marker& marker : *markers) {
    EXPECT_EQ(marker.header.frame_id, "arm/hand");
    EXPECT_EQ(marker.header.stamp, ros::Time());
    EXPECT_TRUE(marker.frame_locked);
  }
  EXPECT_EQ((*markers)[0].id, 4);
  EXPECT_EQ((*markers)[1].id, 5);
}

// RViz: 5 cm, and a quarter of a metre and 2.5 cm for half of the largest effort.
TEST(EffortRings, AreAsLargeAsTheShareOfTheLargestEffort) {
  const double radius = 0.05 + 0.55 / 2;
  const auto markers = Show(JointAbout({0, 0, 1}, 10), StateOf(5));
  const Marker &ring = (*markers)[0], &head = (*markers)[1];
  EXPECT_EQ(ring.type, Marker::LINE_STRIP);
  EXPECT_EQ(ring.scale.x, 0.02);
  ASSERT_THAT(ring.points, SizeIs(30));
  for (std::size_t i = 0; i < 30; ++i) {
    EXPECT_NEAR(At(ring, i).norm(), radius, 1e-9);
    EXPECT_EQ(At(ring, i).z(), 0);
  }
  EXPECT_GT(At(ring, 1).x(), 0);
  EXPECT_TRUE(At(head, 0).isApprox(Eigen::Vector3d(0, radius, 0)));
  EXPECT_TRUE(At(head, 1).isApprox(Eigen::Vector3d(-0.04, radius, 0)));
  EXPECT_EQ(head.scale.y, 0.08);
}

TEST(EffortRings, TurnTheOtherWayForANegativeEffort) {
  const auto markers = Show(JointAbout({0, 0, 1}, 10), StateOf(-5));
  EXPECT_LT(At((*markers)[0], 1).x(), 0);
  EXPECT_GT(At((*markers)[1], 1).x(), 0);
}

TEST(EffortRings, LieAcrossTheAxis) {
  for (const Eigen::Vector3d& axis :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, -2, 0), Eigen::Vector3d(0, 0, -1)}) {
    const auto markers = Show(JointAbout(axis, 10), StateOf(5));
    for (std::size_t i = 0; i < 30; ++i) {
      EXPECT_NEAR(At((*markers)[0], i).dot(axis), 0, 1e-9) << axis.transpose();
    }
  }
}

TEST(EffortRings, GoFromMagentaToRedAtTheLargestEffort) {
  const auto color_of = [](double effort, const ShownStyle& style = {}) {
    const auto color = (*Show(JointAbout({0, 0, 1}, 10), StateOf(effort), style))[0].color;
    return Eigen::Vector4f(color.r, color.g, color.b, color.a);
  };
  EXPECT_TRUE(color_of(1.5).isApprox(Eigen::Vector4f(0, 0, 1, 1), 1e-6F));  // a fifth
  EXPECT_TRUE(color_of(-1.5).isApprox(Eigen::Vector4f(0, 0, 1, 1), 1e-6F));
  EXPECT_TRUE(color_of(1e9).isApprox(Eigen::Vector4f(1, 0, 0, 1), 1e-6F));
  ShownStyle style;
  style.color = Rgb{0, 1, 0};
  style.alpha = 0.5;
  EXPECT_TRUE(color_of(1.5, style).isApprox(Eigen::Vector4f(0, 1, 0, 0.5), 1e-6F));
}

TEST(EffortRings, HaveTheEffortItselfWithoutALargestOne) {
  ShownStyle style;
  style.size_m = 2;
  style.width_m = 0.1;
  const auto markers = Show(JointAbout({0, 0, 1}, 0), StateOf(0.3), style);
  EXPECT_NEAR(At((*markers)[0], 0).norm(), 0.05 + 0.35, 1e-9);
  EXPECT_EQ((*markers)[0].scale.x, 0.1);
  const auto huge = Show(JointAbout({0, 0, 1}, 0), StateOf(1e300), style);
  EXPECT_NEAR(At((*huge)[0], 0).norm(), 100, 1e-9);
}

// A ring that is there goes away.
TEST(EffortRings, AreNotAboutJointsThatSlideOrThatAreLeftOut) {
  const auto is_deleted = [](const Taken<ShownMarkers>& markers) {
    return markers && markers->size() == 2 && (*markers)[0].action == Marker::DELETE &&
           (*markers)[1].action == Marker::DELETE;
  };
  RobotJoint slide = JointAbout({0, 0, 1}, 10);
  slide.type = RobotJoint::Type::kPrismatic;
  EXPECT_TRUE(is_deleted(Show(slide, StateOf(5))));
  EXPECT_TRUE(is_deleted(
      Show(JointAbout({0, 0, 1}, 10), StateOf(std::numeric_limits<double>::quiet_NaN()))));
  ShownStyle style;
  style.frames.hidden = {"lift"};
  EXPECT_TRUE(is_deleted(Show(JointAbout({0, 0, 1}, 10), StateOf(5), style)));
}

TEST(EffortRings, AreAboutTheRobotWithoutAPrefixAmongSeveral) {
  auto arm = std::make_shared<urdf::RobotModel>();
  arm->joints = {JointAbout({0, 0, 1}, 10)};
  arm->joints[0].child_link = "hand";
  ShownJoints joints;
  joints.Add(arm, "r1");
  EXPECT_EQ(joints.Find("lift")->frame, "r1/hand");
  joints.Add(arm, "");
  EXPECT_EQ(joints.Find("lift")->frame, "hand");
  joints.Add(arm, "r2");
  EXPECT_EQ(joints.Find("lift")->frame, "hand");
  EXPECT_FALSE(joints.Find("turn"));
}

TEST(EffortRings, SayWhyThereAreNone) {
  sensor_msgs::JointState state = StateOf(5);
  state.name = {"elbow"};
  const auto unknown = Show(JointAbout({0, 0, 1}, 10), state);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().text, HasSubstr("no robot that is shown has the joint 'elbow'"));
  state.effort.clear();
  const auto without = Show(JointAbout({0, 0, 1}, 10), state);
  ASSERT_FALSE(without);
  EXPECT_THAT(without.error().text, HasSubstr("1 names and 0 efforts"));
  const auto nobody = ToMarkers(StateOf(5), {}, {});
  EXPECT_FALSE(nobody);
  EXPECT_THAT(*Show(JointAbout({0, 0, 1}, 10), {}), IsEmpty());
}

}  // namespace
}  // namespace kinescope::ros_bridge
