#include "urdf/anatomical_limits.h"

#include <gtest/gtest.h>

#include "urdf/segments.h"

namespace kinescope::urdf {
namespace {

void ExpectRange(int joint, int axis, double lower, double upper) {
  const AngleRange range = AnatomicalRangeOf(joint, axis);
  EXPECT_NEAR(range.lower, lower, 1e-9) << kJoints[At(joint)].ros_name << " " << axis;
  EXPECT_NEAR(range.upper, upper, 1e-9) << kJoints[At(joint)].ros_name << " " << axis;
}

// The numbers are those of joint_limits.cc, with clinical signs.
TEST(AnatomicalLimits, AreThoseOfTheUrdfWithClinicalSigns) {
  for (const bool is_left : {false, true}) {
    const auto of = [&](int right, int left) { return is_left ? left : right; };
    ExpectRange(of(jRightKnee, jLeftKnee), 2, -20, 170);
    ExpectRange(of(jRightHip, jLeftHip), 2, -50, 150);
    ExpectRange(of(jRightHip, jLeftHip), 0, -60, 90);
    ExpectRange(of(jRightAnkle, jLeftAnkle), 2, -75, 50);
    ExpectRange(of(jRightBallFoot, jLeftBallFoot), 2, -90, 55);
    ExpectRange(of(jRightWrist, jLeftWrist), 2, -100, 100);
    ExpectRange(of(jRightWrist, jLeftWrist), 0, -55, 55);
    ExpectRange(of(jRightWrist, jLeftWrist), 1, -45, 45);
    ExpectRange(of(jRightC7Shoulder, jLeftC7Shoulder), 0, -30, 50);
  }
  ExpectRange(jL5S1, 2, -25, 45);
}

TEST(AnatomicalLimits, AreAtMostHalfATurnAndUniqueButAtTheShoulder) {
  for (const int joint : {jRightShoulder, jLeftShoulder}) {
    for (int axis = 0; axis < 3; ++axis) ExpectRange(joint, axis, -180, 180);
  }
  for (const int joint : {jRightElbow, jLeftElbow}) {
    ExpectRange(joint, 0, -90, 90);
    ExpectRange(joint, 1, -110, 180);
    ExpectRange(joint, 2, -180, 180);
  }
}

}  // namespace
}  // namespace kinescope::urdf
