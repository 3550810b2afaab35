// The worked examples of joint-loads.md 6, on its reference skeleton R75 (male, 75 kg).
#include "server/loads/static_loads.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

namespace kinescope::loads {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace urdf;

constexpr double kMomentTolerance = 1e-3;  // N m
constexpr double kRatioTolerance = 6e-4;   // the reference prints three digits

Quaterniond Ry(double degrees) {
  return Quaterniond(AngleAxisd(degrees * M_PI / 180, Vector3d::UnitY()));
}

// Case poses are world orientations of some links; all others are upright.
LinkPoses Posed(const std::map<int, Quaterniond>& turned,
                const Vector3d& pelvis = Vector3d(0, 0, 0.990)) {
  const Skeleton skeleton = DefaultSkeleton();
  LinkPoses links;
  links[kPelvis].position = pelvis;
  for (int i = 0; i < kSegmentCount; ++i) {
    const auto turn = turned.find(i);
    if (turn != turned.end()) links[static_cast<std::size_t>(i)].orientation = turn->second;
    if (i == 0) continue;
    const Pose& parent =
        links[static_cast<std::size_t>(kSegments[static_cast<std::size_t>(i)].parent)];
    links[static_cast<std::size_t>(i)].position =
        parent.position +
        parent.orientation * skeleton.origin_in_parent[static_cast<std::size_t>(i)];
  }
  return links;
}

const BodyParameters& Body() {
  static const BodyParameters body = MakeBodyParameters({}, DefaultSkeleton());
  return body;
}

StaticSolution Solve(const LinkPoses& links) {
  return SolveStatics(links, DefaultSkeleton(), Body(), 0.0);
}

Vector3d MomentAt(const StaticSolution& solution, int joint) {
  return solution.moment[static_cast<std::size_t>(ChildOf(joint))];
}

void ExpectMoment(const StaticSolution& solution, int joint, const Vector3d& expected) {
  EXPECT_LT((MomentAt(solution, joint) - expected).norm(), kMomentTolerance)
      << kJoints[static_cast<std::size_t>(joint)].mvn_name << " has "
      << MomentAt(solution, joint).transpose() << ", expected " << expected.transpose();
}

Score ScoreOf(const StaticSolution& solution, const LinkPoses& links, int joint) {
  return ScoreJoint(joint, MomentAt(solution, joint), links, Sex::kMale);
}

TEST(StaticLoads, CaseANPoseNeedsNoMomentAnywhere) {
  const LinkPoses links = Posed({});
  const StaticSolution solution = Solve(links);
  EXPECT_LT((solution.com - Vector3d(0.0020, 0, 1.0079)).norm(), 1e-4);
  ASSERT_TRUE(solution.cop);
  EXPECT_LT((*solution.cop - Vector3d(0.0020, 0, 0)).norm(), 1e-4);
  EXPECT_NEAR(solution.right_foot_share, 0.5, 1e-9);
  // The clavicles carry the arms, the feet stand in front of the ankles, the head leans on nothing.
  for (const int joint : kScoredJoints) ExpectMoment(solution, joint, Vector3d::Zero());
  const std::map<int, double> force_z = {
      {jL5S1, 363.46},      {jT9T8, 195.64},      {jT1C7, 51.06},        {jRightShoulder, 36.35},
      {jRightElbow, 16.41}, {jRightHip, -221.76}, {jRightKnee, -325.94}, {jRightAnkle, -357.80}};
  for (const auto& [joint, expected] : force_z) {
    EXPECT_NEAR(solution.force[static_cast<std::size_t>(ChildOf(joint))].z(), expected, 1e-2);
  }
}

TEST(StaticLoads, CaseB0ArmHorizontalForward) {
  const LinkPoses links =
      Posed({{kRightUpperArm, Ry(-90)}, {kRightForeArm, Ry(-90)}, {kRightHand, Ry(-90)}});
  const StaticSolution solution = Solve(links);
  EXPECT_LT((solution.com - Vector3d(0.0172, 0, 1.0231)).norm(), 1e-4);
  const std::map<int, Vector3d> moments = {
      {jRightWrist, {0, -0.309, 0}},     {jRightElbow, {0, -2.794, 0}},
      {jRightShoulder, {0, -11.169, 0}}, {jRightC7Shoulder, {-6.553, -11.169, 0}},
      {jT9T8, {0, -11.169, 0}},          {jL5S1, {0, -11.169, 0}},
      {jRightHip, {0, 5.584, 0}},        {jRightKnee, {0, 5.584, 0}},
      {jRightAnkle, {0, 5.584, 0}},      {jLeftHip, {0, 5.584, 0}}};
  for (const auto& [joint, expected] : moments) ExpectMoment(solution, joint, expected);
  const std::map<int, double> ratios = {
      {jRightWrist, 0.028}, {jRightElbow, 0.036}, {jRightShoulder, 0.234}, {jT9T8, 0.048},
      {jL5S1, 0.048},       {jRightHip, 0.029},   {jRightKnee, 0.056},     {jRightAnkle, 0.044}};
  for (const auto& [joint, expected] : ratios) {
    EXPECT_NEAR(ScoreOf(solution, links, joint).ratio, expected, kRatioTolerance);
  }
  EXPECT_STREQ(ScoreOf(solution, links, jRightWrist).channel, "radial deviation");
  EXPECT_STREQ(ScoreOf(solution, links, jRightShoulder).channel, "elevation");
}

TEST(StaticLoads, CaseC0TrunkBentForward) {
  std::map<int, Quaterniond> bent;
  for (const int segment : {kL5, kL3, kT12, kT8, kNeck, kHead, kRightShoulder, kLeftShoulder}) {
    bent[segment] = Ry(45);
  }
  const LinkPoses links = Posed(bent);
  const StaticSolution solution = Solve(links);
  EXPECT_LT((solution.com - Vector3d(0.0921, 0, 0.9706)).norm(), 1e-4);
  const std::map<int, std::pair<double, double>> moment_and_ratio = {
      {jL5S1, {-66.290, 0.283}},     {jL4L3, {-44.626, 0.191}},     {jT9T8, {-15.973, 0.068}},
      {jT1C7, {-5.523, 0.108}},      {jC1Head, {-2.469, 0.048}},    {jRightHip, {33.145, 0.174}},
      {jRightKnee, {33.145, 0.331}}, {jRightAnkle, {33.145, 0.263}}};
  for (const auto& [joint, expected] : moment_and_ratio) {
    ExpectMoment(solution, joint, {0, expected.first, 0});
    EXPECT_NEAR(ScoreOf(solution, links, joint).ratio, expected.second, kRatioTolerance)
        << kJoints[static_cast<std::size_t>(joint)].mvn_name;
  }
}

TEST(StaticLoads, CaseESymmetricSquat) {
  std::map<int, Quaterniond> squat;
  for (const int segment :
       {kPelvis, kL5, kL3, kT12, kT8, kNeck, kHead, kRightShoulder, kLeftShoulder}) {
    squat[segment] = Ry(30);
  }
  for (const int leg : {kRightUpperLeg, kLeftUpperLeg}) {
    squat[leg] = Ry(-60);
    squat[leg + 1] = Ry(20);
  }
  for (const int arm : {kRightUpperArm, kLeftUpperArm}) {
    for (int i = 0; i < 3; ++i) squat[arm + i] = Ry(-90);
  }
  LinkPoses links = Posed(squat, {-0.2505, 0, 0.7307});
  const Vector3d to_ankle = Vector3d(0, -0.085, 0.080) - links[kRightFoot].position;
  for (Pose& link : links) link.position += to_ankle;  // the reference rounds the pelvis to 0.1 mm
  const StaticSolution solution = Solve(links);
  EXPECT_LT((solution.com - Vector3d(-0.0428, 0, 0.8093)).norm(), 1e-4);
  const std::map<int, std::pair<double, double>> moment_and_ratio = {
      {jL5S1, {-69.212, 0.296}},
      {jRightShoulder, {-11.169, 0.332}},
      {jRightHip, {45.284, 0.238}},
      {jRightKnee, {-68.791, 0.409}},
      {jRightAnkle, {-16.466, 0.383}}};
  for (const auto& [joint, expected] : moment_and_ratio) {
    EXPECT_NEAR(MomentAt(solution, joint).y(), expected.first, kMomentTolerance);
    EXPECT_NEAR(ScoreOf(solution, links, joint).ratio, expected.second, kRatioTolerance);
  }
}

TEST(StaticLoads, AFootInTheAirCarriesNothing) {
  const LinkPoses standing = Posed({});
  LinkPoses on_left = Posed({{kRightUpperLeg, Ry(-70)}});
  ASSERT_GT(on_left[kRightFoot].position.z(), 0.3);
  const StaticSolution solution = Solve(on_left);
  EXPECT_NEAR(solution.right_foot_share, 0.0, 1e-9);
  LinkPoses jumping = standing;
  for (Pose& link : jumping) link.position.z() += 0.2;
  EXPECT_FALSE(Solve(jumping).cop) << "nothing holds a body in the air";
}

// 6.13: yaw and translation of everything change no ratio; mirroring swaps the sides.
TEST(StaticLoads, DoNotDependOnWhereThePersonStandsAndFaces) {
  std::mt19937 random(20260101);
  std::uniform_real_distribution<double> angle(-0.6, 0.6);
  for (int trial = 0; trial < 50; ++trial) {
    JointAngles angles;
    for (Vector3d& a : angles) a = {angle(random), angle(random), angle(random)};
    const Skeleton skeleton = DefaultSkeleton();
    const LinkPoses links = ForwardKinematics(skeleton, {{0, 0, 1}, Ry(0)}, angles);
    const Quaterniond yaw(AngleAxisd(2.0 * angle(random), Vector3d::UnitZ()));
    LinkPoses moved = links;
    for (Pose& link : moved) {
      link = {yaw * link.position + Vector3d(3, -2, 0), yaw * link.orientation};
    }
    const StaticSolution here = Solve(links), there = Solve(moved);
    for (const int joint : kScoredJoints) {
      EXPECT_LT((yaw * MomentAt(here, joint) - MomentAt(there, joint)).norm(), 1e-9);
      EXPECT_NEAR(ScoreOf(here, links, joint).ratio, ScoreOf(there, moved, joint).ratio, 1e-9);
    }
  }
}

TEST(StaticLoads, OfAMirroredPersonAreMirrored) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-0.6, 0.6);
  const Skeleton skeleton = DefaultSkeleton();
  const auto mirrored_joint = [](int joint) {
    if (joint >= jRightC7Shoulder && joint <= jRightWrist) return joint + 4;
    if (joint >= jLeftC7Shoulder && joint <= jLeftWrist) return joint - 4;
    if (joint >= jRightHip && joint <= jRightBallFoot) return joint + 4;
    if (joint >= jLeftHip) return joint - 4;
    return joint;
  };
  for (int trial = 0; trial < 50; ++trial) {
    JointAngles angles, mirrored;
    for (Vector3d& a : angles) a = {angle(random), angle(random), angle(random)};
    for (int joint = 0; joint < kJointCount; ++joint) {
      const Vector3d& a = angles[static_cast<std::size_t>(mirrored_joint(joint))];
      mirrored[static_cast<std::size_t>(joint)] = {-a.x(), a.y(), -a.z()};
    }
    const LinkPoses links = ForwardKinematics(skeleton, {{0, 0, 1}, Ry(0)}, angles);
    const LinkPoses mirror = ForwardKinematics(skeleton, {{0, 0, 1}, Ry(0)}, mirrored);
    const StaticSolution a = Solve(links), b = Solve(mirror);
    for (const int joint : kScoredJoints) {
      const Score here = ScoreOf(a, links, joint),
                  there = ScoreOf(b, mirror, mirrored_joint(joint));
      EXPECT_NEAR(here.ratio, there.ratio, 1e-9) << kJoints[static_cast<std::size_t>(joint)].label;
    }
  }
}

}  // namespace
}  // namespace kinescope::loads
