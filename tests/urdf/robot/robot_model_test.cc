#include "urdf/robot/robot_model.h"

#include <gtest/gtest.h>

#include <cstdio>

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

TEST(RobotModel, RejectsInvalidUrdfsWithTheReason) {
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
  EXPECT_NE(bad_number.find("link 'a'"), std::string::npos) << bad_number;
  EXPECT_NE(bad_number.find("line 1"), std::string::npos) << bad_number;
}

TEST(RobotModel, ReadsLimitsInertiaCollisionsAndMimicJoints) {
  const RobotModel robot = ParseUrdf(R"(<robot name="r"><link name="a"/>
    <link name="b"><inertial><origin xyz="1 2 3" rpy="0 0 1.5707963267948966"/><mass value="4"/>
        <inertia ixx="1" ixy="0.1" ixz="0.2" iyy="2" iyz="0.3" izz="2.5"/></inertial>
      <collision name="hull"><origin xyz="0 0 1"/><geometry><sphere radius="0.5"/></geometry>
        </collision></link>
    <link name="c"/>
    <joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
      <limit lower="-1" upper="2" effort="30" velocity="4"/><dynamics damping="0.5" friction="0.25"/>
      </joint>
    <joint name="k" type="continuous"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/>
      <mimic joint="j" multiplier="-2" offset="0.5"/></joint></robot>)");
  const Link& b = robot.links.at(1);
  ASSERT_TRUE(b.inertial);
  EXPECT_EQ(b.mass, 4);
  EXPECT_EQ(b.inertial->link_from_inertial.translation(), Eigen::Vector3d(1, 2, 3));
  EXPECT_LT((b.inertial->link_from_inertial.linear().col(0) - Eigen::Vector3d::UnitY()).norm(),
            1e-12);
  Eigen::Matrix3d tensor;
  tensor << 1, 0.1, 0.2, 0.1, 2, 0.3, 0.2, 0.3, 2.5;
  EXPECT_EQ(b.inertial->inertia, tensor);
  ASSERT_EQ(b.collisions.size(), 1u);
  EXPECT_EQ(b.collisions[0].name, "hull");
  EXPECT_EQ(b.collisions[0].geometry.size.x(), 0.5);
  EXPECT_EQ(b.collisions[0].link_from_collision.translation().z(), 1);
  const RobotJoint& j = robot.joints.at(0);
  ASSERT_TRUE(j.limits);
  EXPECT_EQ(j.limits->lower, -1);
  EXPECT_EQ(j.limits->upper, 2);
  EXPECT_EQ(j.limits->effort, 30);
  EXPECT_EQ(j.limits->velocity, 4);
  EXPECT_EQ(j.damping, 0.5);
  EXPECT_EQ(j.friction, 0.25);
  ASSERT_TRUE(robot.joints.at(1).mimic);
  EXPECT_EQ(robot.joints.at(1).mimic->joint, "j");
  EXPECT_EQ(robot.joints.at(1).mimic->multiplier, -2);
  EXPECT_EQ(robot.joints.at(1).mimic->offset, 0.5);
}

TEST(RobotModel, ReportsIgnoredElements) {
  const RobotModel robot = ParseUrdf(R"(<robot name="r">
    <link name="a"><visual><geometry><box size="1 1 1"/></geometry><material name="wood">
      <texture filename="wood.png"/></material></visual></link>
    <link name="b"/><link name="c"/>
    <joint name="free" type="floating"><parent link="a"/><child link="b"/></joint>
    <joint name="flat" type="planar"><parent link="b"/><child link="c"/><axis xyz="0 0 1"/></joint>
    </robot>)");
  EXPECT_FALSE(robot.links.at(0).visuals.at(0).rgba) << "black, which nobody asked for";
  ASSERT_EQ(robot.notes.size(), 3u);
  EXPECT_NE(robot.notes[0].find("wood.png"), std::string::npos) << robot.notes[0];
  EXPECT_EQ(robot.joints.at(0).type, RobotJoint::Type::kFloating);
  EXPECT_EQ(robot.joints.at(1).type, RobotJoint::Type::kPlanar);
}

// As RViz does it.
TEST(RobotModel, WithoutAMaterialHasTheOneUsedLastInTheLink) {
  const RobotModel robot = ParseUrdf(R"(<robot name="r">
    <link name="a"><visual><geometry><box size="1 1 1"/></geometry></visual>
      <visual><geometry><box size="1 1 1"/></geometry><material name="red"><color rgba="1 0 0 1"/>
      </material></visual>
      <visual><geometry><box size="1 1 1"/></geometry></visual></link></robot>)");
  const std::vector<Visual>& visuals = robot.links.at(0).visuals;
  EXPECT_FALSE(visuals.at(0).rgba);
  EXPECT_EQ(visuals.at(2).rgba, Eigen::Vector4d(1, 0, 0, 1));
}

// A chain as long as any that is read: nothing may need a nested call for each link.
std::string Chain(std::size_t links) {
  std::string xml = "<robot name='r'><link name='a000000'/>";
  char text[200];
  for (std::size_t i = 1; i < links; ++i) {
    std::snprintf(text, sizeof text,
                  "<link name='a%06zu'/><joint name='j%zu' type='fixed'><parent link='a%06zu'/>"
                  "<child link='a%06zu'/><origin xyz='0 0 0.5'/></joint>",
                  i, i, i - 1, i);
    xml += text;
  }
  return xml + "</robot>";
}

TEST(RobotModel, ReadsTheLongestAllowedChain) {
  const RobotModel robot = ParseUrdf(Chain(kMaxLinks));
  ASSERT_EQ(robot.links.size(), kMaxLinks);
  EXPECT_EQ(robot.links.back().name, "a009999");
}

TEST(RobotModel, RejectsOversizedAndTooDeeplyNestedDocuments) {
  const std::string deep = ReasonFor(Chain(60'000));
  EXPECT_NE(deep.find("60000 links"), std::string::npos) << deep;
  EXPECT_NE(ReasonFor(Chain(300'000)), "accepted");
  std::string nested = "<robot name='r'>";
  for (int i = 0; i < 100'000; ++i) nested += "<a>";
  EXPECT_NE(ReasonFor(nested).find("deep"), std::string::npos);
  std::string many = "<robot name='r'>";
  for (int i = 0; i < 600'000; ++i) many += "<a/>";
  EXPECT_NE(ReasonFor(many + "</robot>").find("elements"), std::string::npos);
  const std::string huge(40u << 20, ' ');
  EXPECT_NE(ReasonFor(huge).find("41943040 bytes"), std::string::npos);
  std::string laughs = "<?xml version='1.0'?>\n<!DOCTYPE robot [<!ENTITY l0 'ha'>";
  for (int i = 1; i < 30; ++i) {
    const std::string one = "&l" + std::to_string(i - 1) + ";";
    laughs += "<!ENTITY l" + std::to_string(i) + " '" + one + one + one + one + one + "'>";
  }
  const std::string bomb = ReasonFor(laughs + "]><robot name='&l29;'><link name='a'/></robot>");
  EXPECT_NE(bomb.find("line 2: DOCTYPE"), std::string::npos) << bomb;
  const std::string file =
      ReasonFor("<!DOCTYPE r SYSTEM 'file:///etc/passwd'><robot name='r'><link name='a'/></robot>");
  EXPECT_NE(file.find("DOCTYPE"), std::string::npos) << file;
}

TEST(RobotModel, RejectsImpossibleSizes) {
  const auto with = [](const std::string& visual) {
    return ReasonFor("<robot name='r'>\n<link name='a'><visual>\n" + visual +
                     "</visual></link></robot>");
  };
  for (const char* shape :
       {"<geometry><box size='1 1 5000'/></geometry>",
        "<geometry><sphere radius='1e9'/></geometry>", "<geometry><sphere radius='-1'/></geometry>",
        "<geometry><cylinder radius='1' length='inf'/></geometry>",
        "<geometry><mesh filename='a.stl' scale='1e9 1 1'/></geometry>",
        "<geometry><box size='1 1'/></geometry>",
        "<origin xyz='0 0 1e300'/><geometry><sphere radius='1'/></geometry>"}) {
    const std::string reason = with(shape);
    EXPECT_EQ(reason.find("line 3: link 'a'"), 0u) << shape << " gave: " << reason;
  }
}

TEST(RobotModel, ReadsThePublishedHumanModelsOfOtherProjects) {
  KINESCOPE_NEEDS_SHARED_DATA("models/human-gazebo/humanSubject01_66dof.urdf");
  using kinescope::testing::ReadFile;
  using kinescope::testing::SharedData;
  const auto gazebo =
      ParseUrdf(ReadFile(SharedData("models/human-gazebo/humanSubject01_66dof.urdf")));
  EXPECT_EQ(gazebo.root_link, "Pelvis");
  int revolute = 0;
  for (const RobotJoint& joint : gazebo.joints)
    revolute += joint.type == RobotJoint::Type::kRevolute;
  EXPECT_EQ(revolute, 66);
  const auto generated =
      ParseUrdf(ReadFile(SharedData("models/human-model-generator/humanModelTemplate.urdf")));
  EXPECT_EQ(generated.links.size(), 103u);
}

}  // namespace
}  // namespace kinescope::urdf
