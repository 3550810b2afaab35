#include "urdf/anatomical_angles.h"

#include <algorithm>
#include <cmath>

#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond IsbOf(const SegmentOrientations& orientations, int segment) {
  return orientations[At(segment)] * SegmentFromIsb(segment);
}

// (alpha, beta, gamma) of r = Rz(gamma) Rx(alpha) Ry(beta), rad. Where alpha is 90 deg, beta and
// gamma are about one axis: beta is then 0.
Vector3d ZxyTurns(const Matrix3d& r) {
  const double alpha = std::asin(std::clamp(r(2, 1), -1.0, 1.0));
  if (std::hypot(r(2, 0), r(2, 2)) < kGimbalLock) return {alpha, 0, std::atan2(r(1, 0), r(0, 0))};
  return {alpha, std::atan2(-r(2, 0), r(2, 2)), std::atan2(-r(0, 1), r(1, 1))};
}

// The same of r = Rx(alpha) Rz(gamma) Ry(beta), where gamma may be 90 deg.
Vector3d XzyTurns(const Matrix3d& r) {
  const double gamma = std::asin(std::clamp(-r(0, 1), -1.0, 1.0));
  if (std::hypot(r(0, 0), r(0, 2)) < kGimbalLock) return {std::atan2(-r(1, 2), r(2, 2)), 0, gamma};
  return {std::atan2(r(2, 1), r(1, 1)), std::atan2(r(0, 2), r(0, 0)), gamma};
}

// About the forward, the upward and the right axis, deg.
Vector3d Turns(const Quaterniond& parent_from_child, AngleSequence sequence) {
  // Forward, up, right from forward, left, up.
  static const Matrix3d kIsbAxes = (Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished();
  const Matrix3d r = kIsbAxes * parent_from_child.toRotationMatrix() * kIsbAxes.transpose();
  return (sequence == AngleSequence::kZxy ? ZxyTurns(r) : XzyTurns(r)) * (180 / M_PI);
}

Vector3d SignsOf(int joint) {
  if (joint <= jC1Head) return {1, 1, -1};
  const double right = IsLeftJoint(joint) ? -1 : 1;
  const JointGroup group = JointGroupOf(joint);
  const bool bends_back = group == JointGroup::kKnee || group == JointGroup::kBallOfFoot;
  return {-right, right, bends_back ? -1.0 : 1.0};
}

Vector3d SignsOf(ErgonomicAngle angle) {
  if (angle == ErgonomicAngle::kT8LeftUpperArm) return {1, -1, 1};
  if (angle == ErgonomicAngle::kT8RightUpperArm) return {-1, 1, 1};
  return {1, 1, -1};
}

// Upright, with the heading of the x axis of `world_from_pelvis`.
Quaterniond Vertical(const Quaterniond& world_from_pelvis) {
  const Vector3d forward = world_from_pelvis * Vector3d::UnitX();
  return Quaterniond(Eigen::AngleAxisd(std::atan2(forward.y(), forward.x()), Vector3d::UnitZ()));
}

Quaterniond ParentOfErgonomic(ErgonomicAngle angle, const SegmentOrientations& orientations) {
  switch (angle) {
    case ErgonomicAngle::kPelvisT8: return IsbOf(orientations, kPelvis);
    case ErgonomicAngle::kVerticalPelvis:
    case ErgonomicAngle::kVerticalT8: return Vertical(orientations[kPelvis]);
    default: return IsbOf(orientations, kT8);
  }
}

}  // namespace

const std::array<ErgonomicAngleInfo, kErgonomicAngleCount> kErgonomicAngles = {{
    {"T8_Head", "T8", kHead},
    {"T8_LeftUpperArm", "T8", kLeftUpperArm},
    {"T8_RightUpperArm", "T8", kRightUpperArm},
    {"Pelvis_T8", "Pelvis", kT8},
    {"Vertical_Pelvis", "Vertical", kPelvis},
    {"Vertical_T8", "Vertical", kT8},
}};

const Quaterniond& SegmentFromIsb(int segment) {
  // An arm that points sideways in the T-pose points down in its anatomical axes; forearm and hand
  // are also rotated about their long axis, palm forward.
  static const Quaterniond kNone = Quaterniond::Identity();
  static const Quaterniond kRightUpper(M_SQRT1_2, -M_SQRT1_2, 0, 0);
  static const Quaterniond kRightLower(0.5, -0.5, 0.5, 0.5);
  static const Quaterniond kLeftUpper(M_SQRT1_2, M_SQRT1_2, 0, 0);
  static const Quaterniond kLeftLower(0.5, 0.5, 0.5, -0.5);
  switch (segment) {
    case kRightUpperArm: return kRightUpper;
    case kRightForeArm:
    case kRightHand: return kRightLower;
    case kLeftUpperArm: return kLeftUpper;
    case kLeftForeArm:
    case kLeftHand: return kLeftLower;
    default: return kNone;
  }
}

std::array<Vector3d, kJointCount> AnatomicalAngles(const SegmentOrientations& orientations,
                                                   AngleSequence sequence) {
  std::array<Vector3d, kJointCount> angles;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const Quaterniond turn = IsbOf(orientations, urdf::ParentOf(joint)).conjugate() *
                             IsbOf(orientations, ChildOf(joint));
    angles[At(joint)] = SignsOf(joint).cwiseProduct(Turns(turn, sequence));
  }
  return angles;
}

Quaterniond RotationOfJoint(int joint, const Vector3d& degrees) {
  const Vector3d turns = SignsOf(joint).cwiseProduct(degrees) * (M_PI / 180);
  const Quaterniond turn = Eigen::AngleAxisd(turns.z(), -Vector3d::UnitY()) *  // to the right
                           Eigen::AngleAxisd(turns.x(), Vector3d::UnitX()) *
                           Eigen::AngleAxisd(turns.y(), Vector3d::UnitZ());
  return SegmentFromIsb(urdf::ParentOf(joint)) * turn * SegmentFromIsb(ChildOf(joint)).conjugate();
}

std::array<Vector3d, kErgonomicAngleCount> ErgonomicAngles(const SegmentOrientations& orientations,
                                                           AngleSequence sequence) {
  std::array<Vector3d, kErgonomicAngleCount> angles;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const auto angle = static_cast<ErgonomicAngle>(i);
    const Quaterniond turn = ParentOfErgonomic(angle, orientations).conjugate() *
                             IsbOf(orientations, kErgonomicAngles[i].child);
    angles[i] = SignsOf(angle).cwiseProduct(Turns(turn, sequence));
  }
  return angles;
}

}  // namespace kinescope::urdf
