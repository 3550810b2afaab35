// Our loads against KDL's recursive Newton-Euler on our URDF, hung in the world by six more joints:
// another model (joint coordinates instead of measured segments), another library.
#include <gtest/gtest.h>

#include <kdl/tree.hpp>
#include <kdl/treeidsolver_recursive_newton_euler.hpp>
#include <kdl_parser/kdl_parser.hpp>
#include <random>

#include "server/loads/hand_loads.h"
#include "server/loads/inverse_dynamics.h"
#include "server/subject/posture.h"
#include "urdf/human_urdf.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;
using subject::Jet;
using urdf::At;

constexpr double kRelative = 1e-4;
constexpr double kHeldKg = 5;
constexpr const char* kBase = "moving_pelvis";

KDL::Vector ToKdl(const Vector3d& v) { return {v.x(), v.y(), v.z()}; }

KDL::RigidBodyInertia InertiaOf(const urdf::SegmentInertia& segment) {
  const Eigen::Matrix3d& i = segment.inertia_about_com;
  return KDL::RigidBodyInertia(
      segment.mass, ToKdl(segment.com_in_link),
      KDL::RotationalInertia(i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)));
}

// world -> tx ty tz (along the world's axes), z y x -> pelvis -> the URDF's joints.
KDL::Tree TreeOf(const urdf::HumanModel& human) {
  KDL::Tree body;
  EXPECT_TRUE(kdl_parser::treeFromString(urdf::WriteUrdf(human), body));
  KDL::Tree tree("world");
  const std::pair<const char*, KDL::Joint::JointType> joints[] = {
      {"tx", KDL::Joint::TransX}, {"ty", KDL::Joint::TransY}, {"tz", KDL::Joint::TransZ},
      {"rz", KDL::Joint::RotZ},   {"ry", KDL::Joint::RotY},   {"rx", KDL::Joint::RotX}};
  std::string parent = "world";
  for (const auto& [name, type] : joints) {
    const bool is_last = type == KDL::Joint::RotX;
    const std::string link = is_last ? kBase : name + std::string("_link");
    EXPECT_TRUE(tree.addSegment(
        KDL::Segment(link, KDL::Joint(name, type), KDL::Frame::Identity(),
                     is_last ? InertiaOf(human.body[urdf::kPelvis]) : KDL::RigidBodyInertia()),
        parent));
    parent = link;
  }
  EXPECT_TRUE(tree.addTree(body, kBase));
  return tree;
}

// Every joint's angle with its first two derivatives; of the pelvis, place and turn.
struct Motion {
  std::array<Jet, 6> base;                                   // tx ty tz rz ry rx
  std::array<std::array<Jet, 3>, urdf::kJointCount> angles;  // x y z
};

Motion RandomMotion(std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  Motion motion;
  const auto jet = [&] {
    return Jet(1.5 * number(random), 3 * number(random), 10 * number(random));
  };
  for (Jet& coordinate : motion.base) coordinate = jet();
  for (auto& joint : motion.angles) {
    for (Jet& angle : joint) angle = jet();
  }
  return motion;
}

BodySample SampleOf(const Motion& motion, const urdf::Skeleton& skeleton,
                    const urdf::BodyParameters& body) {
  const auto& b = motion.base;
  subject::Posture posture(skeleton);
  posture.PlacePelvis({b[0], b[1], b[2]},
                      subject::TurnZ(b[3]) * subject::TurnY(b[4]) * subject::TurnX(b[5]));
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const auto& [x, y, z] = motion.angles[At(joint)];
    posture.Turn(urdf::ChildOf(joint), subject::TurnY(y) * subject::TurnX(x) * subject::TurnZ(z));
  }
  return posture.ToSample(body);
}

struct Ours {
  urdf::LinkPoses links;
  JointWrenches joints;
};

// As the estimator does it, with a mass in the right hand. The residual of the pelvis stands for
// the ground.
Ours Solve(const BodySample& sample, const urdf::Skeleton& skeleton,
           const urdf::BodyParameters& body) {
  Ours ours;
  ours.links = LinkPosesOf(sample);
  BodyMotion motion;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const SegmentState& segment = sample.segments[At(i)];
    motion[At(i)] = {segment.acceleration, segment.angular_velocity, segment.angular_acceleration};
  }
  HandLoad held;
  held.is_known = true;
  held.mass_kg[urdf::kRight] = kHeldKg;
  HandLoads hands;
  hands.Update(held, 0);
  ExternalForces external;
  std::array<HandForce, 2> shown;
  hands.Push(ours.links, motion, skeleton, {}, 0, external, shown);
  ours.joints = SolveJoints(ours.links, DemandOf(ours.links, motion, body), external);
  return ours;
}

// What the joint's three axes of the URDF (x y z) have to turn with: y first, z last.
Vector3d AboutAxes(const Wrench& wrench, const Eigen::Quaterniond& world_from_parent,
                   const Eigen::Quaterniond& world_from_child, double y) {
  const Eigen::Quaterniond after_y =
      world_from_parent * Eigen::Quaterniond(Eigen::AngleAxisd(y, Vector3d::UnitY()));
  return {wrench.moment.dot(after_y * Vector3d::UnitX()),
          wrench.moment.dot(world_from_parent * Vector3d::UnitY()),
          wrench.moment.dot(world_from_child * Vector3d::UnitZ())};
}

void ExpectSame(double ours, double theirs, const std::string& what) {
  EXPECT_NEAR(ours, theirs, kRelative * std::max(1.0, std::abs(theirs))) << what;
}

TEST(KdlNewtonEuler, GivesTheSameTorquesAsKinescopeWithAHandLoad) {
  urdf::HumanModel human;
  human.skeleton = urdf::DefaultSkeleton();
  human.body = urdf::MakeBodyParameters({}, human.skeleton);
  // To KDL the load is a part of the hand.
  urdf::BodyDescription laden;
  laden.added_masses = {{urdf::kRightHand, kHeldKg, urdf::GripPoint(human.skeleton, urdf::kRight)}};
  urdf::HumanModel laden_human = human;
  laden_human.body = urdf::MakeBodyParameters(laden, human.skeleton);
  const KDL::Tree tree = TreeOf(laden_human);
  ASSERT_EQ(tree.getNrOfJoints(), 6U + 66);
  KDL::TreeIdSolver_RNE solver(tree, KDL::Vector(0, 0, -kGravity));

  std::mt19937 random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const Motion motion = RandomMotion(random);
    const unsigned count = tree.getNrOfJoints();
    KDL::JntArray q(count), rate(count), acceleration(count), torques(count);
    std::map<std::string, unsigned> number_of;
    for (const auto& [link, element] : tree.getSegments()) {
      const KDL::Joint& joint = element.segment.getJoint();
      if (joint.getType() != KDL::Joint::None) number_of[joint.getName()] = element.q_nr;
    }
    const auto set = [&](const std::string& joint, const Jet& jet) {
      const unsigned i = number_of.at(joint);
      q(i) = jet.value;
      rate(i) = jet.rate;
      acceleration(i) = jet.accel;
    };
    const char* const base[] = {"tx", "ty", "tz", "rz", "ry", "rx"};
    for (std::size_t i = 0; i < 6; ++i) set(base[i], motion.base[i]);
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      for (int axis = 0; axis < 3; ++axis) {
        set(urdf::JointName("skeleton", joint, axis), motion.angles[At(joint)][At(axis)]);
      }
    }
    ASSERT_EQ(solver.CartToJnt(q, rate, acceleration, KDL::WrenchMap(), torques), 0);

    const Ours ours =
        Solve(SampleOf(motion, human.skeleton, human.body), human.skeleton, human.body);
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      const std::size_t child = At(urdf::ChildOf(joint));
      const Vector3d needed =
          AboutAxes(ours.joints[child], ours.links[At(urdf::ParentOf(joint))].orientation,
                    ours.links[child].orientation, motion.angles[At(joint)][1].value);
      for (int axis = 0; axis < 3; ++axis) {
        const std::string name = urdf::JointName("skeleton", joint, axis);
        ExpectSame(needed[axis], torques(number_of.at(name)), name);
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      ExpectSame(ours.joints[urdf::kPelvis].force[axis], torques(number_of.at(base[axis])),
                 base[axis]);
    }
    // The pelvis' own turns, world-fixed z first.
    const Vector3d& moment = ours.joints[urdf::kPelvis].moment;
    ExpectSame(moment.z(), torques(number_of.at("rz")), "rz");
    ExpectSame(moment.dot(ours.links[urdf::kPelvis].orientation * Vector3d::UnitX()),
               torques(number_of.at("rx")), "rx");
    ASSERT_FALSE(HasFailure()) << "trial " << trial;
  }
}

}  // namespace
}  // namespace kinescope::loads
