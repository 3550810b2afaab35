// The URDF as KDL has it, through kdl_parser: what robot_state_publisher and most of ROS's
// kinematics and dynamics stand on.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <kdl/chaindynparam.hpp>
#include <kdl/tree.hpp>
#include <kdl/treefksolverpos_recursive.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <map>
#include <random>

#include "server/ros/joint_states.h"
#include "server/ros/transforms.h"
#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Isometry3d;

KDL::Tree TreeOf(const PersonModel& model) {
  KDL::Tree tree;
  EXPECT_TRUE(kdl_parser::treeFromString(model.urdf_xml, tree));
  return tree;
}

urdf::JointAngles RandomAngles(std::mt19937& random) {
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  urdf::JointAngles angles;
  for (Eigen::Vector3d& one : angles) one = {angle(random), angle(random), angle(random)};
  return angles;
}

KDL::JntArray AsKdl(const KDL::Tree& tree, const sensor_msgs::JointState& message) {
  std::map<std::string, double> positions;
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    positions[message.name[i]] = message.position[i];
  }
  KDL::JntArray q(tree.getNrOfJoints());
  for (const auto& [link, element] : tree.getSegments()) {
    const KDL::Joint& joint = element.segment.getJoint();
    if (joint.getType() == KDL::Joint::None) continue;
    q(element.q_nr) = positions.at(joint.getName());
  }
  return q;
}

Isometry3d AsIsometry(const KDL::Frame& frame) {
  Isometry3d result = Isometry3d::Identity();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) result(row, column) = frame.M(row, column);
    result(row, 3) = frame.p[row];
  }
  return result;
}

// Every frame that we publish below the pelvis is where KDL's chain has it.
void ExpectSameFrames(const PersonState& person, const KDL::Tree& tree) {
  const PersonNames names(person.model->human);
  sensor_msgs::JointState joint_states;
  FillComputedJointStates(person, names, joint_states);
  ASSERT_EQ(tree.getNrOfJoints(), joint_states.name.size());
  const KDL::JntArray q = AsKdl(tree, joint_states);
  tf2_msgs::TFMessage transforms;
  FillTransforms(person, names, "lab", TfShape::kFlat, transforms);
  ASSERT_EQ(transforms.transforms.size(), joint_states.name.size() + 1);
  Isometry3d lab_from_pelvis = Isometry3d::Identity();
  lab_from_pelvis.translate(person.links[urdf::kPelvis].position);
  lab_from_pelvis.rotate(person.links[urdf::kPelvis].orientation);
  KDL::TreeFkSolverPos_recursive solver(tree);
  for (const auto& one : transforms.transforms) {
    KDL::Frame pelvis_from_link;
    ASSERT_EQ(solver.JntToCart(q, pelvis_from_link, one.child_frame_id), 0) << one.child_frame_id;
    const auto& t = one.transform.translation;
    const auto& r = one.transform.rotation;
    Isometry3d ours = Isometry3d::Identity();
    ours.translate(Eigen::Vector3d(t.x, t.y, t.z));
    ours.rotate(Eigen::Quaterniond(r.w, r.x, r.y, r.z));
    const Isometry3d theirs = lab_from_pelvis * AsIsometry(pelvis_from_link);
    ASSERT_LT((ours.matrix() - theirs.matrix()).cwiseAbs().maxCoeff(), 1e-9) << one.child_frame_id;
  }
}

TEST(Kdl, GivesTheSameLinkPosesAsKinescopeForRandomPoses) {
  const auto model = testing::MakeModel();
  const KDL::Tree tree = TreeOf(*model);
  EXPECT_EQ(tree.getNrOfJoints(), 66U);
  EXPECT_EQ(tree.getNrOfSegments(), 66U);
  std::mt19937 random(5);
  for (int trial = 0; trial < 100; ++trial) {
    const PersonState person = testing::MakePerson(model, RandomAngles(random), 1, 1);
    ASSERT_NO_FATAL_FAILURE(ExpectSameFrames(person, tree)) << "trial " << trial;
  }
}

TEST(Kdl, GivesTheSamePosesOfFingersAndPropsAsKinescope) {
  const auto model = testing::MakeGlovedModel();
  const KDL::Tree tree = TreeOf(*model);
  EXPECT_EQ(tree.getNrOfJoints(), 66U + 120 + 12);
  std::mt19937 random(6);
  for (int trial = 0; trial < 20; ++trial) {
    PersonState person = testing::MakePerson(model, RandomAngles(random), 1, 1);
    testing::BendFingers(trial, person);
    ASSERT_NO_FATAL_FAILURE(ExpectSameFrames(person, tree)) << "trial " << trial;
  }
}

TEST(Kdl, ReadsTheMassOfTheBodyAndSolvesItsDynamicsWithMasslessLinks) {
  const auto model = testing::MakeModel();
  const KDL::Tree tree = TreeOf(*model);
  double mass = model->human.body[urdf::kPelvis].mass;  // KDL leaves the root's inertia out
  for (const auto& [link, element] : tree.getSegments()) {
    mass += element.segment.getInertia().getMass();
  }
  EXPECT_NEAR(mass, 75, 1e-9);
  for (const char* tip : {"skeleton_right_hand", "skeleton_left_toe", "skeleton_head"}) {
    KDL::Chain chain;
    ASSERT_TRUE(tree.getChain("skeleton_pelvis", tip, chain)) << tip;
    KDL::ChainDynParam dynamics(chain, KDL::Vector(0, 0, -9.81));
    const unsigned joints = chain.getNrOfJoints();
    KDL::JntSpaceInertiaMatrix inertia(joints);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> angle(-1, 1);  // away from the lock
    for (int trial = 0; trial < 50; ++trial) {
      KDL::JntArray q(joints);
      for (unsigned i = 0; i < joints; ++i) q(i) = angle(random);
      ASSERT_EQ(dynamics.JntToMass(q, inertia), 0);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(inertia.data);
      EXPECT_GT(solver.eigenvalues().minCoeff(), 1e-6) << tip << ": the mass matrix is singular";
    }
  }
}

}  // namespace
}  // namespace kinescope::ros_bridge
