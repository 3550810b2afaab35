#include "urdf/robot/robot_kinematics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

RobotModel WithJoint(const std::string& type, const std::string& inner,
                     const std::string& more = "") {
  return ParseUrdf("<robot name='r'><link name='a'/><link name='b'/><joint name='j' type='" + type +
                   "'><parent link='a'/><child link='b'/><origin xyz='1 0 0'/><axis xyz='0 0 2'/>" +
                   inner + "</joint>" + more + "</robot>");
}

constexpr char kWide[] = "<limit lower='-2' upper='2' effort='1' velocity='1'/>";

TEST(RobotKinematics, RotatesAndSlidesAlongAnAxisOfAnyLength) {
  const auto turned = PlaceLinks(WithJoint("revolute", kWide), {{"j", M_PI / 2}});
  EXPECT_LT((turned.at(1) * Vector3d::UnitX() - Vector3d(1, 1, 0)).norm(), 1e-12);
  const auto slid = PlaceLinks(WithJoint("prismatic", kWide), {{"j", 0.25}});
  EXPECT_LT((slid.at(1).translation() - Vector3d(1, 0, 0.25)).norm(), 1e-12);
  const auto moved =
      PlaceLinks(WithJoint("fixed", ""), {}, Eigen::Isometry3d(Eigen::Translation3d(0, 0, 5)));
  EXPECT_LT((moved.at(1).translation() - Vector3d(1, 0, 5)).norm(), 1e-12);
}

TEST(RobotKinematics, UsesZeroOrTheNearestLimitByDefault) {
  const auto angle = [](const std::string& type, const std::string& limit) {
    const auto links = PlaceLinks(WithJoint(type, limit));
    const Vector3d x = links.at(1).linear().col(0);
    return std::atan2(x.y(), x.x());
  };
  EXPECT_DOUBLE_EQ(angle("revolute", kWide), 0);
  EXPECT_NEAR(angle("revolute", "<limit lower='0.3' upper='2' effort='1' velocity='1'/>"), 0.3,
              1e-12);
  EXPECT_NEAR(angle("revolute", "<limit lower='-2' upper='-0.4' effort='1' velocity='1'/>"), -0.4,
              1e-12);
  EXPECT_DOUBLE_EQ(angle("continuous", "<limit lower='1' upper='2' effort='1' velocity='1'/>"), 0);
  // Limits the wrong way round bound nothing.
  EXPECT_DOUBLE_EQ(angle("revolute", "<limit lower='2' upper='1' effort='1' velocity='1'/>"), 0);
}

TEST(RobotKinematics, MovesMimicJointsUnlessTheirAngleIsGiven) {
  const std::string follower =
      "<link name='c'/><joint name='k' type='revolute'><parent link='a'/><child link='c'/>"
      "<axis xyz='0 0 1'/><limit lower='-9' upper='9' effort='1' velocity='1'/>"
      "<mimic joint='j' multiplier='-2' offset='0.1'/></joint>";
  const RobotModel robot = WithJoint("revolute", kWide, follower);
  const auto angle_of_c = [&](const JointPositions& positions) {
    const Vector3d x = PlaceLinks(robot, positions).at(2).linear().col(0);
    return std::atan2(x.y(), x.x());
  };
  EXPECT_NEAR(angle_of_c({{"j", 0.5}}), -0.9, 1e-12);
  EXPECT_NEAR(angle_of_c({{"j", 0.5}, {"k", 0.2}}), 0.2, 1e-12);
}

TEST(RobotKinematics, HasFinitePosesForExtremeValues) {
  const std::string ring =
      "<link name='c'/><joint name='k' type='prismatic'><parent link='a'/><child link='c'/>"
      "<axis xyz='0 0 1'/><limit lower='1e300' upper='1e301' effort='1' velocity='1'/>"
      "<mimic joint='k' multiplier='1e200' offset='1e200'/></joint>";
  for (const Eigen::Isometry3d& link : PlaceLinks(WithJoint("revolute", kWide, ring))) {
    EXPECT_TRUE(link.matrix().allFinite());
  }
}

TEST(RobotKinematics, RejectsAnglesOfUnknownAndFixedJoints) {
  EXPECT_THROW(PlaceLinks(WithJoint("revolute", kWide), {{"elbow", 1}}), UrdfError);
  EXPECT_THROW(PlaceLinks(WithJoint("fixed", ""), {{"j", 1}}), UrdfError);
}

}  // namespace
}  // namespace kinescope::urdf
