#include "urdf/anatomical_limits.h"

#include <algorithm>
#include <cmath>

#include "urdf/anatomical_angles.h"
#include "urdf/joint_limits.h"
#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

constexpr double kDegreesPerRadian = 180 / M_PI;

// Of the joint in the URDF, deg.
Eigen::Vector3d LinkAngles(int joint, const Eigen::Vector3d& anatomical) {
  return kDegreesPerRadian *
         AnglesFromRotation(SegmentFromLink(ParentOf(joint)).conjugate() *
                            RotationOfJoint(joint, anatomical) * SegmentFromLink(ChildOf(joint)));
}

double LargestAngle(int joint, int axis) {
  const bool is_ambiguous = axis == 0 && JointGroupOf(joint) != JointGroup::kShoulder;
  return is_ambiguous ? 90 : 180;
}

}  // namespace

AngleRange AnatomicalRangeOf(int joint, int axis) {
  // From its rest, each anatomical angle turns about one axis of the URDF, in one direction: at the
  // wrist about another one, at the elbow from another zero.
  const Eigen::Vector3d rest = LinkAngles(joint, Eigen::Vector3d::Zero());
  const Eigen::Vector3d step = LinkAngles(joint, Eigen::Vector3d::Unit(axis)) - rest;
  int link_axis = 0;
  step.cwiseAbs().maxCoeff(&link_axis);
  const double sign = step[link_axis] > 0 ? 1 : -1;
  const AxisLimit limit = LimitOf(joint, link_axis);
  const double a = sign * (limit.lower * kDegreesPerRadian - rest[link_axis]);
  const double b = sign * (limit.upper * kDegreesPerRadian - rest[link_axis]);
  const double largest = LargestAngle(joint, axis);
  return {std::max(std::min(a, b), -largest), std::min(std::max(a, b), largest)};
}

}  // namespace kinescope::urdf
