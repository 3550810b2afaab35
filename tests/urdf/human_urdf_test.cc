#include "urdf/human_urdf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "urdf/kinematics.h"
#include "urdf/robot_model.h"

namespace kinescope::urdf {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

HumanModel Human(const std::string& name = "skeleton") {
  HumanModel human;
  human.model_name = name;
  human.skeleton = DefaultSkeleton();
  human.body = MakeBodyParameters({}, human.skeleton);
  return human;
}

TEST(HumanUrdf, Has23LinksWithMassAnd66RevoluteJoints) {
  const RobotModel robot = ParseUrdf(WriteUrdf(Human()));
  EXPECT_EQ(robot.root_link, "skeleton_pelvis");
  int with_mass = 0;
  double mass = 0;
  for (const Link& link : robot.links) {
    mass += link.mass;
    with_mass += link.mass > 0;
    EXPECT_EQ(link.mass > 0, !link.visuals.empty()) << link.name;
  }
  EXPECT_EQ(with_mass, kSegmentCount);
  EXPECT_NEAR(mass, 75.0, 1e-5);
  EXPECT_EQ(robot.links.size(), std::size_t{kSegmentCount + 2 * kJointCount});
  ASSERT_EQ(robot.joints.size(), std::size_t{3} * kJointCount);
  for (const RobotJoint& joint : robot.joints) {
    EXPECT_EQ(joint.type, RobotJoint::Type::kRevolute) << joint.name;
  }
}

// Chains the URDF itself, joint by joint, by the names of its joints.
std::map<std::string, Isometry3d> Chain(const RobotModel& robot, const Isometry3d& root,
                                        const std::map<std::string, double>& positions) {
  std::map<std::string, Isometry3d> world_from_link = {{robot.root_link, root}};
  for (const RobotJoint& joint : robot.joints) {
    world_from_link[joint.child_link] =
        world_from_link.at(joint.parent_link) * joint.parent_from_joint *
        Isometry3d(Eigen::AngleAxisd(positions.at(joint.name), joint.axis.normalized()));
  }
  return world_from_link;
}

TEST(HumanUrdf, MovesAsOurOwnKinematicsSays) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(-1.2, 1.2);
  const HumanModel human = Human();
  const RobotModel robot = ParseUrdf(WriteUrdf(human));
  for (int trial = 0; trial < 100; ++trial) {
    JointAngles angles;
    std::map<std::string, double> positions;
    for (int joint = 0; joint < kJointCount; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        angles[static_cast<std::size_t>(joint)][axis] =
            positions[JointName("skeleton", joint, axis)] = angle(random);
      }
    }
    const Pose pelvis = {{1, -2, 0.97}, RotationFromAngles({0.1, 0.4, -2})};
    const LinkPoses links = ForwardKinematics(human.skeleton, pelvis, angles);
    Isometry3d root = Isometry3d::Identity();
    root.linear() = pelvis.orientation.toRotationMatrix();
    root.translation() = pelvis.position;
    const auto chained = Chain(robot, root, positions);
    for (int i = 0; i < kSegmentCount; ++i) {
      const Isometry3d& link = chained.at(LinkName("skeleton", i));
      const Pose& ours = links[static_cast<std::size_t>(i)];
      EXPECT_LT((link.translation() - ours.position).norm(), 1e-6)
          << kSegments[static_cast<std::size_t>(i)].link_name;
      EXPECT_LT(Eigen::Quaterniond(link.linear()).angularDistance(ours.orientation), 1e-6);
    }
  }
}

TEST(HumanUrdf, KeepsUnsafeNamesOutOfTheDocument) {
  const RobotModel robot = ParseUrdf(WriteUrdf(Human("a<b>\"&/ c")));
  EXPECT_EQ(robot.root_link, "a_b_____c_pelvis");
}

TEST(HumanUrdf, NamesItsMeshesWhereAFolderIsGiven) {
  HumanModel human = Human();
  human.mesh_folder = "/some/folder";
  for (const Link& link : ParseUrdf(WriteUrdf(human)).links) {
    if (link.mass == 0) continue;
    ASSERT_EQ(link.visuals.size(), 1u);
    EXPECT_EQ(link.visuals[0].geometry.kind, Geometry::Kind::kMesh);
    EXPECT_EQ(link.visuals[0].geometry.mesh_uri,
              "file:///some/folder/" + link.name.substr(std::string("skeleton_").size()) + ".stl");
  }
}

}  // namespace
}  // namespace kinescope::urdf
