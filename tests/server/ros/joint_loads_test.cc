#include "server/ros/joint_loads.h"

#include <gtest/gtest.h>

#include <cmath>

#include "server/ros/names.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using kinescope_ros::JointLoad;
using urdf::At;

TEST(JointLoads, ContainEveryScoredJointWithValuesOrReason) {
  PersonState person = testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 7);
  person.loads[0].reason = "no foot contact";
  person.loads[0].load_class = LoadClass::kUnknown;
  person.loads[0].ratio = std::nan("");
  person.loads[1].ratio = 0.42;
  person.loads[1].load_class = LoadClass::kMedium;
  person.loads[1].channel = "elevation";
  person.loads[1].deciding_moment = 12.5;
  person.loads[1].capacity = 50;
  person.loads[2].is_external = true;
  kinescope_ros::JointLoadArray message;
  FillJointLoads(person, "world", message);
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.header.stamp.toNSec(), 7u);
  ASSERT_EQ(message.loads.size(), person.loads.size());
  const auto& unknown = message.loads[0];
  EXPECT_EQ(unknown.joint, "jL5S1");
  EXPECT_EQ(unknown.load_class, JointLoad::UNKNOWN);
  EXPECT_FALSE(unknown.valid);
  EXPECT_TRUE(std::isnan(unknown.ratio));
  EXPECT_EQ(unknown.reason, "no foot contact");
  const auto& known = message.loads[1];
  EXPECT_EQ(known.joint, "jRightShoulder");
  EXPECT_TRUE(known.valid);
  EXPECT_EQ(known.load_class, JointLoad::MEDIUM);
  EXPECT_EQ(known.ratio, 0.42);
  EXPECT_EQ(known.channel, "elevation");
  EXPECT_EQ(known.channel_moment, 12.5);
  EXPECT_EQ(known.capacity, 50);
  EXPECT_EQ(known.moment[2], person.loads[1].moment.z());
  EXPECT_EQ(known.source, JointLoad::COMPUTED);
  EXPECT_EQ(message.loads[2].source, JointLoad::EXTERNAL);
}

TEST(JointLoads, MarkUnknownValuesOfTheWholeBody) {
  PersonState person = testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 7);
  person.cop.reset();
  person.forces.metric = LoadMetric::kOverload;
  person.forces.why_static = "no accelerations";
  person.forces.body_mass_is_assumed = true;
  kinescope_ros::JointLoadArray message;
  FillJointLoads(person, "world", message);
  EXPECT_EQ(message.metric, kinescope_ros::JointLoadArray::OVERLOAD);
  EXPECT_TRUE(std::isnan(message.cop.x));
  EXPECT_FALSE(message.cop_measured);
  EXPECT_FALSE(message.dynamic);
  EXPECT_EQ(message.why_static, "no accelerations");
  EXPECT_TRUE(message.body_mass_assumed);
  EXPECT_TRUE(std::isnan(message.l5_s1_compression));
  EXPECT_TRUE(std::isnan(message.margin_of_stability));
}

TEST(JointNames, OfBothSchemesFindTheSameJoint) {
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    for (int axis = 0; axis < 3; ++axis) {
      const char letter = static_cast<char>('x' + axis);
      const NamedJoint ours = FindNamedJoint(urdf::JointName("my_robot", joint, axis));
      EXPECT_EQ(ours.joint, joint);
      EXPECT_EQ(ours.axis, axis);
      EXPECT_FALSE(ours.is_rot);
      const std::string mvn(urdf::kJoints[At(joint)].mvn_name);
      const NamedJoint theirs = FindNamedJoint(mvn + "_rot" + letter);
      EXPECT_EQ(theirs.joint, joint) << mvn;
      EXPECT_EQ(theirs.axis, axis);
      EXPECT_TRUE(theirs.is_rot);
    }
    EXPECT_EQ(FindNamedJoint(urdf::kJoints[At(joint)].ros_name).joint, joint);
    EXPECT_EQ(FindNamedJoint(urdf::kJoints[At(joint)].ros_name).axis, -1);
  }
  EXPECT_EQ(FindNamedJoint("skeleton_right_ball_foot_x").joint, urdf::jRightBallFoot);
  EXPECT_EQ(FindNamedJoint("jLeftT4Shoulder").joint, urdf::jLeftC7Shoulder);
  EXPECT_EQ(FindNamedJoint("human/jL5S1").joint, urdf::jL5S1);
}

TEST(JointNames, FindNoJointForUnknownNames) {
  for (const char* name : {"", "_", "x", "_x", "shoulder_pan_joint", "right_finger_x", "rotx",
                           "left", "right_shoulder_lift_joint"}) {
    EXPECT_EQ(FindNamedJoint(name).joint, -1) << name;
  }
  EXPECT_EQ(FindNamedJoint(std::string(100'000, '_')).joint, -1) << "and without taking its time";
}

}  // namespace
}  // namespace kinescope::ros_bridge
