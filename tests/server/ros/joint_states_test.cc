#include "server/ros/joint_states.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/server/ros/test_person.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDegree = M_PI / 180;

std::size_t RowOf(int joint) {
  for (std::size_t row = 0; row < JointsByName().size(); ++row) {
    if (JointsByName()[row] == joint) return row;
  }
  ADD_FAILURE() << "no row for joint " << joint;
  return 0;
}

Vector3d RowAt(const std::vector<double>& values, int joint) {
  const double* const row = &values[3 * RowOf(joint)];
  return {row[0], row[1], row[2]};
}

PersonState StandingPerson() {
  return testing::MakePerson(testing::MakeModel(), testing::Posture(1), 5, 2'000'000'003);
}

TEST(JointStates, ContainTheAnglesOfThePoses) {
  const PersonState person = StandingPerson();
  sensor_msgs::JointState message;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  EXPECT_EQ(message.header.stamp, ros::Time(2, 3));
  ASSERT_EQ(message.name.size(), 66U);
  ASSERT_EQ(message.position.size(), 66U);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    EXPECT_EQ(RowAt(message.position, joint), person.angles[At(joint)]);
    EXPECT_EQ(message.name[3 * RowOf(joint) + 1], urdf::JointName("skeleton", joint, 1));
  }
}

TEST(JointStates, HaveNoVelocitiesIfNoneWereMeasured) {
  PersonState person = StandingPerson();
  sensor_msgs::JointState message;
  person.sample.has_angular = true;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  EXPECT_EQ(message.velocity.size(), 66U);
  person.sample.has_angular = false;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  EXPECT_TRUE(message.velocity.empty());
}

// World-axes rates of all links, by differentiating their orientations.
void MeasureRates(const urdf::JointAngles& before, const urdf::JointAngles& after, double dt,
                  PersonState& person) {
  const urdf::Pose pelvis{Vector3d::Zero(), person.links[urdf::kPelvis].orientation};
  const auto& skeleton = person.model->human.skeleton;
  const auto first = urdf::ForwardKinematics(skeleton, pelvis, before);
  const auto second = urdf::ForwardKinematics(skeleton, pelvis, after);
  for (std::size_t i = 0; i < first.size(); ++i) {
    const AngleAxisd turn(second[i].orientation * first[i].orientation.conjugate());
    person.sample.segments[i].angular_velocity = turn.axis() * turn.angle() / dt;
  }
  person.sample.has_angular = true;
}

TEST(JointStates, HaveVelocitiesThatAreTheDerivativesOfThePositions) {
  const double dt = 1e-5;
  PersonState person = StandingPerson();
  const urdf::JointAngles rates = testing::Posture(0.4);
  urdf::JointAngles before = person.angles;
  urdf::JointAngles after = person.angles;
  for (std::size_t joint = 0; joint < before.size(); ++joint) {
    before[joint] -= rates[joint] * dt / 2;
    after[joint] += rates[joint] * dt / 2;
  }
  MeasureRates(before, after, dt, person);
  sensor_msgs::JointState message;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    EXPECT_TRUE(RowAt(message.velocity, joint).isApprox(rates[At(joint)], 1e-5))
        << "joint " << joint << ": " << RowAt(message.velocity, joint).transpose();
  }
}

TEST(JointStates, HaveFiniteVelocitiesInGimbalLock) {
  const Vector3d rate(0.3, 1.0, 7.0);
  for (const double x : {M_PI_2, -M_PI_2, M_PI_2 - 1e-6}) {
    const Vector3d rates = AngleRates({x, 0.2, 0.1}, rate);
    EXPECT_LT(rates.norm(), rate.norm()) << rates.transpose();
    // The part of the motion that the two axes can still make is made.
    const Vector3d turned = AngleAxisd(-0.2, Vector3d::UnitY()) * rate;
    EXPECT_NEAR(rates.x(), turned.x(), 1e-12);
    EXPECT_NEAR(rates.y() - rates.z() * std::sin(x), turned.y(), 1e-9);
  }
}

TEST(JointStates, HaveTheMomentAboutEachAxisAsEffortOrNaNIfUnknown) {
  const PersonState person = StandingPerson();
  sensor_msgs::JointState message;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  ASSERT_EQ(message.effort.size(), 66U);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const JointForce& load = person.forces.joints[At(joint)];
    const Vector3d effort = RowAt(message.effort, joint);
    EXPECT_EQ(effort.hasNaN(), !load.why_unknown.empty()) << "joint " << joint;
    if (!load.why_unknown.empty()) continue;
    // Virtual work: turning one axis by d moves the child by d about it, and the load does M.axis
    // d.
    const Quaterniond& parent = person.links[At(urdf::ParentOf(joint))].orientation;
    const Vector3d& angles = person.angles[At(joint)];
    for (int axis = 0; axis < 3; ++axis) {
      const double d = 1e-6;
      const Vector3d nudged = angles + d * Vector3d::Unit(axis);
      const AngleAxisd turn(parent * urdf::RotationFromAngles(nudged) *
                            (parent * urdf::RotationFromAngles(angles)).conjugate());
      EXPECT_NEAR(effort[axis], load.moment.dot(turn.axis() * turn.angle()) / d, 1e-4);
    }
  }
}

TEST(JointStates, HaveEffortsIndependentOfPositionAndHeading) {
  const PersonState person = StandingPerson();
  PersonState moved = person;
  const Quaterniond turn(AngleAxisd(2.1, Vector3d(0.3, -0.5, 0.8).normalized()));
  for (urdf::Pose& link : moved.links) {
    link.position = turn * link.position + Vector3d(3, -2, 1);
    link.orientation = turn * link.orientation;
  }
  for (JointForce& force : moved.forces.joints) force.moment = turn * force.moment;
  sensor_msgs::JointState here, there;
  FillComputedJointStates(person, PersonNames("skeleton"), here);
  FillComputedJointStates(moved, PersonNames("skeleton"), there);
  for (std::size_t i = 0; i < here.effort.size(); ++i) {
    EXPECT_TRUE(std::isnan(here.effort[i]) ? std::isnan(there.effort[i])
                                           : std::abs(here.effort[i] - there.effort[i]) < 1e-9);
  }
}

TEST(JointStates, HaveNoEffortsIfNoLoadIsKnown) {
  PersonState person = StandingPerson();
  MakeUnknown("flight", person.forces);
  sensor_msgs::JointState message;
  FillComputedJointStates(person, PersonNames("skeleton"), message);
  EXPECT_TRUE(message.effort.empty());
}

// MVN's (x, y, z), degrees, of a joint whose child is turned by Ry(-gamma) Rx(alpha) Rz(beta) in
// MVN's frames of joint angles: signs make every number positive for the same movement of both
// sides. Knees and balls of the feet are flexed backwards and downwards; so they are in recordings
// (anatomical_angles.h).
Vector3d AsMvnStreams(int joint, double alpha, double beta, double gamma) {
  using namespace urdf;
  const bool is_knee = joint == jRightKnee || joint == jLeftKnee || joint == jRightBallFoot ||
                       joint == jLeftBallFoot;
  const std::string name(kJoints[At(joint)].ros_name);
  Vector3d angles(alpha, beta, -gamma);
  if (name.rfind("right_", 0) == 0) angles = {-alpha, beta, is_knee ? -gamma : gamma};
  if (name.rfind("left_", 0) == 0) angles = {alpha, -beta, is_knee ? -gamma : gamma};
  return angles / kDegree;
}

// How MVN's frames of joint angles are turned against our link frames: both are identity in the
// N-pose, but that MVN's forearms and hands have the palm forward.
Quaterniond LinkFromMvn(int segment) {
  using namespace urdf;
  if (segment == kRightForeArm || segment == kRightHand) {
    return Quaterniond(AngleAxisd(M_PI_2, Vector3d::UnitZ()));
  }
  if (segment == kLeftForeArm || segment == kLeftHand) {
    return Quaterniond(AngleAxisd(-M_PI_2, Vector3d::UnitZ()));
  }
  return Quaterniond::Identity();
}

TEST(JointStates, HaveStreamedAnglesEqualToComputedOnesExceptAtWristsAndBallsOfTheFeet) {
  PersonState person = StandingPerson();
  auto& streamed = person.sample.streamed_angles_deg.emplace();
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const Quaterniond parent =
        person.links[At(urdf::ParentOf(joint))].orientation * LinkFromMvn(urdf::ParentOf(joint));
    const Quaterniond child =
        person.links[At(urdf::ChildOf(joint))].orientation * LinkFromMvn(urdf::ChildOf(joint));
    const Vector3d angles = urdf::AnglesFromRotation(parent.conjugate() * child);
    streamed[At(joint)] = AsMvnStreams(joint, angles.x(), angles.z(), -angles.y());
  }
  sensor_msgs::JointState message;
  ASSERT_TRUE(FillStreamedJointStates(person, PersonNames("skeleton"), message));
  ASSERT_EQ(message.position.size(), 66U);
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const bool is_wrist = joint == urdf::jRightWrist || joint == urdf::jLeftWrist;
    const bool is_ball = joint == urdf::jRightBallFoot || joint == urdf::jLeftBallFoot;
    const Vector3d difference = RowAt(message.position, joint) - person.angles[At(joint)];
    EXPECT_EQ(difference.norm() < 1e-9, !is_wrist && !is_ball)
        << "joint " << joint << " is off by " << difference.transpose();
    if (!is_ball) continue;
    EXPECT_NEAR(difference.y(), -2 * person.angles[At(joint)].y(), 1e-9)
        << "xsens_mvn_ros takes its sign for that of the ankle";
  }
}

TEST(JointStates, HaveStreamedAnglesInTheConventionOfXsensMvnRos) {
  const Vector3d streamed(10, 20, 30);
  const auto expect = [&](int joint, double x, double y, double z) {
    EXPECT_TRUE(SeedAngles(joint, streamed).isApprox(Vector3d(x, y, z) * kDegree, 1e-12))
        << joint << ": " << SeedAngles(joint, streamed).transpose() / kDegree;
  };
  expect(urdf::jL5S1, 10, 30, 20);
  expect(urdf::jC1Head, 10, 30, 20);
  expect(urdf::jRightC7Shoulder, -10, -30, 20);
  expect(urdf::jRightElbow, -10, -30, 20 - 90);
  expect(urdf::jRightKnee, -10, 30, 20);
  expect(urdf::jRightBallFoot, -10, -30, 20);
  expect(urdf::jLeftC7Shoulder, 10, -30, -20);
  expect(urdf::jLeftElbow, 10, -30, -20 + 90);
  expect(urdf::jLeftKnee, 10, 30, -20);
  expect(urdf::jLeftBallFoot, 10, -30, -20);
}

TEST(JointStates, AreNotFilledFromMissingStreamedAngles) {
  PersonState person = StandingPerson();
  sensor_msgs::JointState message;
  EXPECT_FALSE(FillStreamedJointStates(person, PersonNames("skeleton"), message));
  EXPECT_TRUE(message.position.empty());
}

TEST(JointStates, OfGlovesAndPropsFollowTheBodyAndHaveNoMeasuredRates) {
  PersonState person =
      testing::MakePerson(testing::MakeGlovedModel(), testing::Posture(1), 5, 2'000'000'003);
  testing::BendFingers(0.3, person);
  person.sample.has_angular = true;
  const PersonNames names(person.model->human);
  sensor_msgs::JointState message;
  FillComputedJointStates(person, names, message);
  constexpr std::size_t kBody = 66, kHand = 60, kProp = 6;
  const std::size_t all = kBody + 2 * kHand + 2 * kProp;
  ASSERT_EQ(message.name.size(), all);
  ASSERT_EQ(message.position.size(), all);
  ASSERT_EQ(message.velocity.size(), all);
  EXPECT_EQ(std::vector<std::string>(message.name.begin(), message.name.begin() + kBody),
            PersonNames("skeleton").joints);
  EXPECT_EQ(message.name[kBody + 3 * 5], "skeleton_left_second_pp_x");
  EXPECT_EQ(message.position[kBody + 3 * 5], person.gloves[urdf::kLeft]->angles[5].x());
  EXPECT_EQ(message.name[kBody + kHand + 2], "skeleton_right_carpus_z");
  EXPECT_EQ(message.position[kBody + kHand + 2], person.gloves[urdf::kRight]->angles[0].z());
  EXPECT_EQ(message.name[kBody + 2 * kHand + kProp + 3], "skeleton_prop2_y");
  EXPECT_EQ(message.position[kBody + 2 * kHand + kProp + 3], person.props[1]->angles.y());
  EXPECT_FALSE(std::isnan(message.velocity[kBody - 1]));
  EXPECT_TRUE(std::isnan(message.velocity[kBody]));
  EXPECT_TRUE(message.effort.empty() || message.effort.size() == all);
}

}  // namespace
}  // namespace kinescope::ros_bridge
