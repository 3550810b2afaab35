#include "server/subject/mvn_angles.h"

#include <cmath>

namespace kinescope::subject {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;

// MVN measures angles between frames that are those of our links, but for forearms and hands: there
// it has the palms forward where our links have the thumbs forward.
Quaterniond LinkFromAngleFrame(int segment) {
  const auto about_z = [](double angle) {
    return Quaterniond(Eigen::AngleAxisd(angle, Vector3d::UnitZ()));
  };
  switch (segment) {
    case urdf::kRightForeArm:
    case urdf::kRightHand: return about_z(M_PI_2);
    case urdf::kLeftForeArm:
    case urdf::kLeftHand: return about_z(-M_PI_2);
    default: return Quaterniond::Identity();
  }
}

// Signs of MVN's (x, y, z) against the turns about forward, up and left that a link makes.
Vector3d Signs(int joint) {
  if (joint <= urdf::jC1Head) return {1, 1, 1};
  const bool right = (joint >= urdf::jRightC7Shoulder && joint <= urdf::jRightWrist) ||
                     (joint >= urdf::jRightHip && joint <= urdf::jRightBallFoot);
  const bool knee = joint == urdf::jRightKnee || joint == urdf::jLeftKnee;
  return {right ? -1.0 : 1.0, right ? 1.0 : -1.0, knee ? 1.0 : -1.0};
}

// Of the two triples that mean one rotation, the one with |x| <= 90 deg, as an arc sine gives it.
Vector3d WithSmallX(const Vector3d& xyz) {
  if (std::abs(xyz.x()) <= M_PI_2) return xyz;
  return {std::copysign(M_PI, xyz.x()) - xyz.x(), std::remainder(xyz.y() + M_PI, 2 * M_PI),
          std::remainder(xyz.z() + M_PI, 2 * M_PI)};
}

}  // namespace

std::array<Vector3d, urdf::kJointCount> StreamedAngles(const urdf::LinkPoses& links) {
  std::array<Vector3d, urdf::kJointCount> angles;
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const int parent = urdf::ParentOf(joint);
    const int child = urdf::ChildOf(joint);
    const Quaterniond turn =
        (links[At(parent)].orientation * LinkFromAngleFrame(parent)).conjugate() *
        (links[At(child)].orientation * LinkFromAngleFrame(child));
    const Vector3d xyz = WithSmallX(urdf::AnglesFromRotation(turn));
    angles[At(joint)] = Signs(joint).cwiseProduct(Vector3d(xyz.x(), xyz.z(), xyz.y())) * 180 / M_PI;
  }
  return angles;
}

}  // namespace kinescope::subject
