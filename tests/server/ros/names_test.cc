#include "server/ros/names.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using ::testing::ElementsAre;

TEST(RosNames, ListJointsInAlphabeticalOrder) {
  const PersonNames names("skeleton");
  ASSERT_EQ(names.joints.size(), 66U);
  std::vector<std::string> bare;
  const std::string prefix = "skeleton_";
  for (std::size_t i = 0; i < names.joints.size(); i += 3) {
    const std::string name = names.joints[i].substr(prefix.size());
    EXPECT_EQ(names.joints[i], prefix + name);
    EXPECT_EQ(name.substr(name.size() - 2), "_x");
    bare.push_back(name.substr(0, name.size() - 2));
    EXPECT_EQ(names.joints[i + 1], prefix + bare.back() + "_y");
    EXPECT_EQ(names.joints[i + 2], prefix + bare.back() + "_z");
  }
  EXPECT_THAT(bare, ElementsAre("c1_head", "l1_t12", "l4_l3", "l5_s1", "left_ankle",
                                "left_ballfoot", "left_c7_shoulder", "left_elbow", "left_hip",
                                "left_knee", "left_shoulder", "left_wrist", "right_ankle",
                                "right_ballfoot", "right_c7_shoulder", "right_elbow", "right_hip",
                                "right_knee", "right_shoulder", "right_wrist", "t1_c7", "t9_t8"));
}

TEST(RosNames, ContainEveryLinkAndJointOfTheUrdfOnce) {
  const auto model = testing::MakeModel("anna");
  const PersonNames names("anna");
  std::set<std::string> links(names.links.begin(), names.links.end());
  for (const auto& pair : names.between) links.insert(pair.begin(), pair.end());
  std::set<std::string> in_urdf;
  for (const urdf::Link& link : model->robot.links) in_urdf.insert(link.name);
  EXPECT_EQ(links, in_urdf);

  std::set<std::string> joints_in_urdf;
  for (const urdf::RobotJoint& joint : model->robot.joints) joints_in_urdf.insert(joint.name);
  EXPECT_EQ(std::set<std::string>(names.joints.begin(), names.joints.end()), joints_in_urdf);
}

TEST(RosNames, AreValidForAnyInput) {
  EXPECT_EQ(AsRosName("anna_2"), "anna_2");
  EXPECT_EQ(AsRosName("Änne B/../"), "person___nne_B____");
  EXPECT_EQ(AsRosName("2nd"), "person_2nd");
  EXPECT_EQ(AsRosName(""), "person_");
}

}  // namespace
}  // namespace kinescope::ros_bridge
