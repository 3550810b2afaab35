/// The reference person R75 (joint-loads.md 6.1: male, 75 kg, 1.750 m) in the poses of the worked
/// examples, and random motion.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <random>

#include "server/loads/load_estimator.h"
#include "urdf/body_parameters.h"

namespace kinescope::loads::testing {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using namespace urdf;  // segment and joint names

constexpr double kMomentTolerance = 1e-3;  // N m, as 6 asks for
constexpr double kForceTolerance = 1e-2;   // N
constexpr double kPointTolerance = 1e-4;   // m
constexpr double kRatioTolerance = 6e-4;   // the reference prints three digits

inline Quaterniond Ry(double degrees) {
  return Quaterniond(AngleAxisd(degrees * M_PI / 180, Vector3d::UnitY()));
}

inline const Skeleton& Person() {
  static const Skeleton skeleton = DefaultSkeleton();
  return skeleton;
}

inline const BodyParameters& Body() {
  static const BodyParameters body = MakeBodyParameters({}, Person());
  return body;
}

/// World orientations of some links; all others upright. The pelvis as in the N-pose.
inline LinkPoses Posed(const std::map<int, Quaterniond>& turned,
                       const Vector3d& pelvis = Vector3d(0, 0, 0.990)) {
  LinkPoses links;
  links[kPelvis].position = pelvis;
  for (int i = 0; i < kSegmentCount; ++i) {
    const auto turn = turned.find(i);
    if (turn != turned.end()) links[At(i)].orientation = turn->second;
    if (i == 0) continue;
    const Pose& parent = links[At(kSegments[At(i)].parent)];
    links[At(i)].position = parent.position + parent.orientation * Person().origin_in_parent[At(i)];
  }
  return links;
}

inline LinkPoses ArmForward() {  // case B
  return Posed({{kRightUpperArm, Ry(-90)}, {kRightForeArm, Ry(-90)}, {kRightHand, Ry(-90)}});
}

inline LinkPoses TrunkBent() {  // case C
  std::map<int, Quaterniond> bent;
  for (const int segment : {kL5, kL3, kT12, kT8, kNeck, kHead, kRightShoulder, kLeftShoulder}) {
    bent[segment] = Ry(45);
  }
  return Posed(bent);
}

inline LinkPoses Squat() {  // case E
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
  return links;
}

/// A sample of these poses, as a suit would send it: segment frames. Static unless `motion` is
/// given.
inline BodySample SampleOf(const LinkPoses& links, std::int64_t stamp_nanos = 1,
                           const BodyMotion* motion = nullptr) {
  BodySample sample;
  sample.stamp_nanos = stamp_nanos;
  for (int i = 0; i < kSegmentCount; ++i) {
    SegmentState& segment = sample.segments[At(i)];
    segment.position = links[At(i)].position;
    segment.orientation = links[At(i)].orientation * SegmentFromLink(i).conjugate();
    if (motion == nullptr) continue;
    segment.acceleration = (*motion)[At(i)].acceleration;
    segment.angular_velocity = (*motion)[At(i)].angular_velocity;
    segment.angular_acceleration = (*motion)[At(i)].angular_acceleration;
  }
  sample.has_linear = sample.has_angular = motion != nullptr;
  return sample;
}

/// As the worked examples are: both feet flat, weights 1, nothing clamped.
inline LoadSettings Unclamped() {
  LoadSettings settings;
  settings.clamp_cop = false;
  return settings;
}

/// One sample through a fresh estimator.
inline LoadResult Estimate(const LinkPoses& links, const LoadSettings& settings = Unclamped(),
                           const BodyMotion* motion = nullptr, const Measurements& measured = {}) {
  LoadEstimator estimator;
  return estimator.Update(SampleOf(links, 1, motion), links, {Person(), Body()}, settings,
                          measured);
}

/// At the grip point of R75, which is rounded to whole millimetres.
inline HandLoad Held(double right_kg, double left_kg = 0) {
  HandLoad load;
  load.is_known = true;
  load.mass_kg = {right_kg, left_kg};
  load.com_in_hand = {Vector3d(0, 0, -0.080), Vector3d(0, 0, -0.080)};
  return load;
}

inline const JointForce& At(const LoadResult& result, int joint) {
  return result.forces.joints[urdf::At(joint)];
}

inline const JointLoad& LoadOf(const LoadResult& result, int joint) {
  for (const JointLoad& load : result.loads) {
    if (load.joint == joint) return load;
  }
  ADD_FAILURE() << "joint " << joint << " is not scored";
  return result.loads[0];
}

inline void ExpectMoment(const LoadResult& result, int joint, const Vector3d& expected,
                         double tolerance = kMomentTolerance) {
  const Vector3d& moment = At(result, joint).moment;
  EXPECT_LT((moment - expected).norm(), tolerance)
      << kJoints[urdf::At(joint)].mvn_name << " has " << moment.transpose() << ", expected "
      << expected.transpose();
}

inline void ExpectRatio(const LoadResult& result, int joint, double expected) {
  EXPECT_NEAR(LoadOf(result, joint).ratio, expected, kRatioTolerance)
      << kJoints[urdf::At(joint)].mvn_name << ", " << LoadOf(result, joint).channel;
}

inline int Mirrored(int joint) {
  if (joint >= jRightC7Shoulder && joint <= jRightWrist) return joint + 4;
  if (joint >= jLeftC7Shoulder && joint <= jLeftWrist) return joint - 4;
  if (joint >= jRightHip && joint <= jRightBallFoot) return joint + 4;
  if (joint >= jLeftHip) return joint - 4;
  return joint;
}

/// Numbers in [-most, most], always the same ones for a seed.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double Number(double most) {
    return std::uniform_real_distribution<double>(-most, most)(engine_);
  }
  Vector3d Vector(double most) { return {Number(most), Number(most), Number(most)}; }
  LinkPoses Pose(double most_angle = 0.6) {
    JointAngles angles;
    for (Vector3d& angle : angles) angle = Vector(most_angle);
    return ForwardKinematics(Person(), {{Number(1), Number(1), 0.97}, Ry(0)}, angles);
  }
  BodyMotion Motion() {
    BodyMotion motion;
    for (SegmentMotion& segment : motion) segment = {Vector(5), Vector(3), Vector(20)};
    return motion;
  }

 private:
  std::mt19937 engine_;
};

}  // namespace kinescope::loads::testing
