#include "urdf/robot_model.h"

#include <gtest/gtest.h>

#include "tests/shared_data.h"

namespace kinescope::urdf {
namespace {

std::string ReasonFor(const std::string& xml) {
  try {
    ParseUrdf(xml);
  } catch (const UrdfError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RobotModel, ReadsShapesColoursAndOrigins) {
  const RobotModel robot = ParseUrdf(R"(<robot name="r">
    <material name="red"><color rgba="1 0 0 0.5"/></material>
    <link name="base"><visual><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/>
      <geometry><box size="4 5 6"/></geometry><material name="red"/></visual></link>
    <link name="tip"><visual><geometry>
      <mesh filename="package://p/a.stl" scale="-1 1 2"/></geometry></visual></link>
    <joint name="j" type="prismatic"><parent link="base"/><child link="tip"/>
      <axis xyz="0 1 0"/><limit effort="1" velocity="1" lower="0" upper="1"/></joint></robot>)");
  ASSERT_EQ(robot.links.size(), 2u);
  const Visual& box = robot.links[0].visuals.at(0);
  EXPECT_EQ(box.geometry.size, Eigen::Vector3d(4, 5, 6));
  EXPECT_LT((box.link_from_visual * Eigen::Vector3d::UnitX() - Eigen::Vector3d(1, 3, 3)).norm(),
            1e-12);
  ASSERT_TRUE(box.rgba);
  EXPECT_EQ(*box.rgba, Eigen::Vector4d(1, 0, 0, 0.5));
  const Geometry& mesh = robot.links[1].visuals.at(0).geometry;
  EXPECT_EQ(mesh.mesh_uri, "package://p/a.stl");
  EXPECT_EQ(mesh.size, Eigen::Vector3d(-1, 1, 2));
  EXPECT_EQ(robot.joints.at(0).type, RobotJoint::Type::kPrismatic);
}

TEST(RobotModel, RefusesWhatIsNoUrdfAndSaysWhy) {
  EXPECT_NE(ReasonFor(""), "accepted");
  EXPECT_NE(ReasonFor("this is not XML"), "accepted");
  EXPECT_NE(ReasonFor("<robot name='r'></robot>"), "accepted");
  const std::string missing = ReasonFor(
      "<robot name='r'><link name='a'/><joint name='j' type='fixed'><parent link='a'/>"
      "<child link='ghost'/></joint></robot>");
  EXPECT_NE(missing.find("ghost"), std::string::npos) << missing;
  const std::string loop = ReasonFor(
      "<robot name='r'><link name='a'/><link name='b'/>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='fixed'><parent link='b'/><child link='a'/></joint></robot>");
  EXPECT_NE(loop, "accepted");
  const std::string two_parents = ReasonFor(
      "<robot name='r'><link name='a'/><link name='b'/><link name='c'/>"
      "<joint name='j' type='fixed'><parent link='a'/><child link='b'/></joint>"
      "<joint name='k' type='fixed'><parent link='b'/><child link='c'/></joint>"
      "<joint name='l' type='fixed'><parent link='c'/><child link='b'/></joint></robot>");
  EXPECT_NE(two_parents.find("'b'"), std::string::npos) << two_parents;
  const std::string bad_number = ReasonFor(
      "<robot name='r'><link name='a'><visual><origin xyz='nan 0 0'/><geometry>"
      "<box size='1 1 1'/></geometry></visual></link></robot>");
  EXPECT_NE(bad_number.find("[a]"), std::string::npos) << bad_number;
}

TEST(RobotModel, ReadsTheHumansOfOthers) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-gazebo/humanSubject01_66dof.urdf");
  using testing::ReadFile;
  using testing::SharedData;
  const auto gazebo =
      ParseUrdf(ReadFile(SharedData("models/human-gazebo/humanSubject01_66dof.urdf")));
  EXPECT_EQ(gazebo.root_link, "Pelvis");
  int revolute = 0;
  for (const RobotJoint& joint : gazebo.joints)
    revolute += joint.type == RobotJoint::Type::kRevolute;
  EXPECT_EQ(revolute, 66);
  const auto generated =
      ParseUrdf(ReadFile(SharedData("models/human-model-generator/humanModelTemplate.urdf")));
  EXPECT_GT(generated.links.size(), 23u);
}

}  // namespace
}  // namespace kinescope::urdf
