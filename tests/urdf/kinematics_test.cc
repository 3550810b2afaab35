#include "urdf/kinematics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>
#include <string>

namespace kinescope::urdf {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(Kinematics, RotatesAboutYThenXThenZ) {
  const Vector3d xyz(0.3, -0.7, 1.1);
  const Quaterniond by_hand = AngleAxisd(-0.7, Vector3d::UnitY()) *
                              AngleAxisd(0.3, Vector3d::UnitX()) *
                              AngleAxisd(1.1, Vector3d::UnitZ());
  EXPECT_LT(RotationFromAngles(xyz).angularDistance(by_hand), 1e-15);
}

std::string InDigits(double value) {
  std::ostringstream text;
  text << value;  // to_string would make 1e-16 a zero
  return text.str();
}

// Uniform over all rotations.
Quaterniond RandomRotation(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized();
}

TEST(Kinematics, RestoresTenThousandRandomPosesOfEveryJointFromTheirAngles) {
  std::mt19937 random(42);
  const Skeleton skeleton = DefaultSkeleton();
  JointAngles angles{};
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    LinkPoses poses;
    for (Pose& pose : poses) pose.orientation = RandomRotation(random);
    angles = AnglesFromPoses(poses, angles);
    const LinkPoses back = ForwardKinematics(skeleton, poses[kPelvis], angles);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      worst = std::max(worst, back[k].orientation.angularDistance(poses[k].orientation));
    }
  }
  EXPECT_LT(worst, 1e-9);
  RecordProperty("worst_rad", InDigits(worst));
}

TEST(Kinematics, RestoresAnglesFromRotationsNearGimbalLock) {
  std::mt19937 random(43);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_real_distribution<double> small(-M_PI_2 + 1e-6, M_PI_2 - 1e-6);
  for (int i = 0; i < 10000; ++i) {
    const Vector3d xyz(small(random), angle(random), angle(random));
    const Vector3d back = AnglesFromRotation(RotationFromAngles(xyz), xyz);
    EXPECT_LT((back - xyz).norm(), 1e-9 / std::cos(xyz.x())) << xyz.transpose();
  }
}

// Down to where y and z are told apart no more (kGimbalLock): the rotation still comes back to the
// last digits, and so do the angles, as far as a rotation can tell them.
TEST(Kinematics, RestoresTenThousandRandomPosesOfEveryJointNearGimbalLock) {
  std::mt19937 random(44);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_real_distribution<double> magnitude(std::log10(2 * kGimbalLock), -1);
  const Skeleton skeleton = DefaultSkeleton();
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    JointAngles truth;
    for (Vector3d& xyz : truth) {
      const double from_lock = std::pow(10, magnitude(random));
      const double side = random() % 2 == 0 ? 1 : -1;
      const double beyond = random() % 2 == 0 ? 1 : -1;  // also on the far side of 90 degrees
      xyz = {side * (M_PI_2 + beyond * from_lock), angle(random), angle(random)};
    }
    const Pose pelvis{Vector3d::Zero(), RandomRotation(random)};
    const LinkPoses poses = ForwardKinematics(skeleton, pelvis, truth);
    const JointAngles angles = AnglesFromPoses(poses, truth);
    const LinkPoses back = ForwardKinematics(skeleton, pelvis, angles);
    for (std::size_t k = 0; k < poses.size(); ++k) {
      worst = std::max(worst, back[k].orientation.angularDistance(poses[k].orientation));
    }
    for (std::size_t joint = 0; joint < truth.size(); ++joint) {
      EXPECT_LT((angles[joint] - truth[joint]).norm(),
                1e-14 / std::abs(std::cos(truth[joint].x())) + 1e-9)
          << truth[joint].transpose();
    }
  }
  EXPECT_LT(worst, 1e-12);
  RecordProperty("worst_rad", InDigits(worst));
}

// What a quaternion is after it was sent as MVN sends it.
Quaterniond AsStreamed(const Quaterniond& q) {
  return Quaterniond(q.cast<float>().cast<double>()).normalized();
}

// A smooth motion of one joint whose x goes to and fro through 90 degrees.
struct SmoothMotion {
  explicit SmoothMotion(std::mt19937& random) {
    std::uniform_real_distribution<double> size(-1.5, 1.5);
    std::uniform_real_distribution<double> rate(0.2, 2.5);
    for (Vector3d& amplitude : amplitudes) amplitude = {size(random), size(random), size(random)};
    for (Vector3d& speed : speeds) speed = {rate(random), rate(random), rate(random)};
    center = {M_PI_2 * (size(random) > 0 ? 1 : -1), size(random), size(random)};
  }
  Vector3d At(double t) const {
    Vector3d angles = center;
    for (std::size_t i = 0; i < amplitudes.size(); ++i) {
      angles += amplitudes[i].cwiseProduct((speeds[i] * t).array().sin().matrix());
    }
    return angles;
  }
  std::array<Vector3d, 2> amplitudes, speeds;
  Vector3d center;
};

TEST(Kinematics, KeepsAnglesSmoothInRandomMotionsThroughGimbalLock) {
  std::mt19937 random(7);
  constexpr double kPeriod = 1.0 / 240;
  int crossings = 0;
  for (int motion = 0; motion < 300; ++motion) {
    const SmoothMotion truth(random);
    Vector3d before = truth.At(0);
    Vector3d true_before = before;
    for (int step = 1; step < 1200; ++step) {
      const Vector3d now = truth.At(step * kPeriod);
      const Quaterniond rotation = AsStreamed(RotationFromAngles(now));
      const Vector3d angles = AnglesFromRotation(rotation, before);
      // Rounding moves y and z against each other, the more the nearer to the lock; within it they
      // stay where they were.
      const double cos_x = std::abs(std::cos(now.x()));
      const double rounding = cos_x < 2 * kGimbalLock ? 0.5 : 4e-7 / cos_x;
      const double moved = (now - true_before).norm();
      ASSERT_LT((angles - now).norm(), 2 * moved + rounding + 1e-6)
          << "motion " << motion << ", step " << step << ", true angles " << now.transpose()
          << ", found " << angles.transpose();
      ASSERT_LT(RotationFromAngles(angles).angularDistance(rotation), 1e-6);
      const auto lock_of = [](double x) { return std::floor(x / M_PI + 0.5); };
      crossings += lock_of(now.x()) != lock_of(true_before.x());
      before = angles;
      true_before = now;
    }
  }
  EXPECT_GT(crossings, 300) << "the motions do not reach the lock";
}

TEST(Kinematics, KeepsAnglesOfARestingJointSteadyInGimbalLock) {
  std::mt19937 random(8);
  std::normal_distribution<double> noise(0, 1e-8);
  const Vector3d truth(M_PI_2, 0.7, -0.4);
  Vector3d before = truth;
  for (int step = 0; step < 10000; ++step) {
    const Quaterniond parent = RandomRotation(random);
    const Quaterniond shaken =
        RotationFromAngles(truth + Vector3d(noise(random), noise(random), noise(random)));
    // Both ends of the joint are streamed, each rounded by itself.
    const Quaterniond rotation = AsStreamed(parent).conjugate() * AsStreamed(parent * shaken);
    const Vector3d angles = AnglesFromRotation(rotation, before);
    ASSERT_LT((angles - before).norm(), 1e-5) << "step " << step << ": " << angles.transpose();
    ASSERT_LT(RotationFromAngles(angles).angularDistance(rotation), 1e-6);
    before = angles;
  }
}

TEST(Kinematics, KeepsAnglesContinuousBeyondHalfARevolution) {
  Vector3d before = Vector3d::Zero();
  for (int step = 0; step <= 720; ++step) {
    const Vector3d truth(0.2, step * M_PI / 180, -step * M_PI / 360);
    const Vector3d now = AnglesFromRotation(RotationFromAngles(truth), before);
    EXPECT_LT((now - truth).norm(), 1e-9) << "at step " << step;
    before = now;
  }
}

TEST(Kinematics, KeepsAnglesContinuousThroughGimbalLock) {
  Vector3d before(80 * M_PI / 180, 0.4, -0.2);
  for (int step = 0; step <= 40; ++step) {
    const double x_deg = 80 + 0.5 * step;
    const Vector3d truth(x_deg * M_PI / 180, 0.4, -0.2);
    const Quaterniond rotation = RotationFromAngles(truth);
    const Vector3d now = AnglesFromRotation(rotation, before);
    EXPECT_LT((now - before).norm(), 0.01) << "at x = " << x_deg << " deg";
    EXPECT_LT(RotationFromAngles(now).angularDistance(rotation), 1e-7);
    before = now;
  }
}

TEST(Kinematics, RestoresTheAnglesGivenToForwardKinematics) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  JointAngles angles;
  for (Vector3d& a : angles) a = {angle(random), angle(random), angle(random)};
  const Pose pelvis = {{1, 2, 0.9}, RotationFromAngles({0.1, 0.2, 0.3})};
  const LinkPoses links = ForwardKinematics(DefaultSkeleton(), pelvis, angles);
  const JointAngles back = AnglesFromPoses(links, {});
  for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_LT((back[i] - angles[i]).norm(), 1e-12);
}

TEST(Kinematics, InterpolatesAlongTheShorterWayForEitherQuaternionSign) {
  LinkPoses a, b;
  a[kHead].orientation = RotationFromAngles({0, 0, 0.1});
  b[kHead].orientation = RotationFromAngles({0, 0, 0.3});
  b[kHead].orientation.coeffs() *= -1;
  b[kHead].position = {2, 0, 0};
  const LinkPoses half = Interpolate(a, b, 0.5);
  EXPECT_LT(half[kHead].orientation.angularDistance(RotationFromAngles({0, 0, 0.2})), 1e-12);
  EXPECT_DOUBLE_EQ(half[kHead].position.x(), 1);
}

TEST(Kinematics, InterpolatesUniformlyBetweenRandomRotationsOfEitherSign) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> share(0, 1);
  for (int i = 0; i < 1000; ++i) {
    LinkPoses a, b;
    a[kHead].orientation = RandomRotation(random);
    b[kHead].orientation = RandomRotation(random);
    const double whole = a[kHead].orientation.angularDistance(b[kHead].orientation);
    const double t = share(random);
    const Quaterniond between = Interpolate(a, b, t)[kHead].orientation;
    EXPECT_NEAR(between.norm(), 1, 1e-12);
    EXPECT_NEAR(a[kHead].orientation.angularDistance(between), t * whole, 1e-7);
    EXPECT_NEAR(between.angularDistance(b[kHead].orientation), (1 - t) * whole, 1e-7);
  }
}

}  // namespace
}  // namespace kinescope::urdf
