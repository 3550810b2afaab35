#include "urdf/kinematics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace kinescope::urdf {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

TEST(Kinematics, ChainsYThenXThenZ) {
  const Vector3d xyz(0.3, -0.7, 1.1);
  const Quaterniond by_hand = AngleAxisd(-0.7, Vector3d::UnitY()) *
                              AngleAxisd(0.3, Vector3d::UnitX()) *
                              AngleAxisd(1.1, Vector3d::UnitZ());
  EXPECT_LT(RotationFromAngles(xyz).angularDistance(by_hand), 1e-15);
}

TEST(Kinematics, AnglesAndRotationsAreInverseForRandomPoses) {
  std::mt19937 random(42);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  std::uniform_real_distribution<double> small(-M_PI_2 + 1e-6, M_PI_2 - 1e-6);
  for (int i = 0; i < 10000; ++i) {
    const Vector3d xyz(small(random), angle(random), angle(random));
    const Quaterniond rotation = RotationFromAngles(xyz);
    const Vector3d back = AnglesFromRotation(rotation, xyz);
    EXPECT_LT((back - xyz).norm(), 1e-9 / std::cos(xyz.x())) << xyz.transpose();
    EXPECT_LT(RotationFromAngles(AnglesFromRotation(rotation)).angularDistance(rotation), 1e-9);
  }
}

TEST(Kinematics, AnglesDoNotJumpWhenAJointTurnsPastHalfATurn) {
  Vector3d before = Vector3d::Zero();
  for (int step = 0; step <= 720; ++step) {
    const Vector3d truth(0.2, step * M_PI / 180, -step * M_PI / 360);
    const Vector3d now = AnglesFromRotation(RotationFromAngles(truth), before);
    EXPECT_LT((now - truth).norm(), 1e-9) << "at step " << step;
    before = now;
  }
}

TEST(Kinematics, AnglesStayContinuousThroughGimbalLock) {
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

TEST(Kinematics, ForwardKinematicsGivesBackTheAnglesItWasGiven) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> angle(-1.0, 1.0);
  JointAngles angles;
  for (Vector3d& a : angles) a = {angle(random), angle(random), angle(random)};
  const Pose pelvis = {{1, 2, 0.9}, RotationFromAngles({0.1, 0.2, 0.3})};
  const LinkPoses links = ForwardKinematics(DefaultSkeleton(), pelvis, angles);
  const JointAngles back = AnglesFromPoses(links, {});
  for (std::size_t i = 0; i < angles.size(); ++i) EXPECT_LT((back[i] - angles[i]).norm(), 1e-12);
}

TEST(Kinematics, InterpolationTakesTheShorterWayWhateverTheSign) {
  LinkPoses a, b;
  a[kHead].orientation = RotationFromAngles({0, 0, 0.1});
  b[kHead].orientation = RotationFromAngles({0, 0, 0.3});
  b[kHead].orientation.coeffs() *= -1;
  b[kHead].position = {2, 0, 0};
  const LinkPoses half = Interpolate(a, b, 0.5);
  EXPECT_LT(half[kHead].orientation.angularDistance(RotationFromAngles({0, 0, 0.2})), 1e-12);
  EXPECT_DOUBLE_EQ(half[kHead].position.x(), 1);
}

}  // namespace
}  // namespace kinescope::urdf
