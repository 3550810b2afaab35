#include "urdf/kinematics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kinescope::urdf {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// `angle` + 2 pi n, as near to `near` as can be.
double Unwind(double angle, double near) {
  return angle + 2 * M_PI * std::round((near - angle) / (2 * M_PI));
}

// The turn about z that is left of `r` after the turns about y and x. Reading z from `r` itself, as
// y is, would give both an error of their own, which grows towards the lock; this way what y has
// too much z has too little, and the rotation stays right to the last digits.
double TurnLeftAboutZ(const Matrix3d& r, double y, double x) {
  const Matrix3d rest =
      (AngleAxisd(y, Vector3d::UnitY()) * AngleAxisd(x, Vector3d::UnitX())).toRotationMatrix();
  return std::atan2(rest.col(1).dot(r.col(0)), rest.col(0).dot(r.col(0)));
}

double Distance(const Vector3d& a, const Vector3d& b) { return (a - b).squaredNorm(); }

}  // namespace

Quaterniond RotationFromAngles(const Vector3d& xyz) {
  return AngleAxisd(xyz.y(), Vector3d::UnitY()) * AngleAxisd(xyz.x(), Vector3d::UnitX()) *
         AngleAxisd(xyz.z(), Vector3d::UnitZ());
}

Vector3d AnglesFromRotation(const Quaterniond& parent_from_child, const Vector3d& near) {
  // Ry(y) Rx(x) Rz(z) =
  //   [ cy cz + sy sx sz   -cy sz + sy sx cz   sy cx ]
  //   [ cx sz               cx cz              -sx   ]
  //   [ -sy cz + cy sx sz   sy sz + cy sx cz    cy cx ]
  const Matrix3d r = parent_from_child.normalized().toRotationMatrix();
  const double cos_x = std::hypot(r(1, 0), r(1, 1));
  if (cos_x < kGimbalLock) {
    const double x = r(1, 2) > 0 ? -M_PI_2 : M_PI_2;
    // y and z now turn about one axis: keep y, give the rest to z.
    const double y = near.y();
    return {Unwind(x, near.x()), y, Unwind(TurnLeftAboutZ(r, y, x), near.z())};
  }
  // atan2 and not asin: asin loses half of the digits near 90 degrees.
  const double x = std::atan2(-r(1, 2), cos_x);
  const double y = std::atan2(r(0, 2), r(2, 2));
  const Vector3d first(x, y, TurnLeftAboutZ(r, y, x));
  const Vector3d second(M_PI - first.x(), first.y() + M_PI, first.z() + M_PI);
  const auto unwound = [&](const Vector3d& angles) {
    return Vector3d(Unwind(angles.x(), near.x()), Unwind(angles.y(), near.y()),
                    Unwind(angles.z(), near.z()));
  };
  const Vector3d a = unwound(first);
  const Vector3d b = unwound(second);
  return Distance(b, near) < Distance(a, near) ? b : a;
}

JointAngles AnglesFromPoses(const LinkPoses& poses, const JointAngles& near) {
  JointAngles angles;
  for (int joint = 0; joint < kJointCount; ++joint) {
    const Quaterniond& parent = poses[At(ParentOf(joint))].orientation;
    const Quaterniond& child = poses[At(ChildOf(joint))].orientation;
    angles[At(joint)] = AnglesFromRotation(parent.conjugate() * child, near[At(joint)]);
  }
  return angles;
}

LinkPoses ForwardKinematics(const Skeleton& skeleton, const Pose& pelvis,
                            const JointAngles& angles) {
  LinkPoses links;
  links[kPelvis] = pelvis;
  for (int segment = 1; segment < kSegmentCount; ++segment) {  // parents come first
    const Pose& parent = links[At(kSegments[At(segment)].parent)];
    links[At(segment)].position =
        parent.position + parent.orientation * skeleton.origin_in_parent[At(segment)];
    links[At(segment)].orientation =
        (parent.orientation * RotationFromAngles(angles[At(segment - 1)])).normalized();
  }
  return links;
}

Pose Relative(const Pose& from, const Pose& to) {
  const Quaterniond back = from.orientation.conjugate();
  return {back * (to.position - from.position), back * to.orientation};
}

std::array<Vector3d, 2> SolePoints(const Skeleton& skeleton, const LinkPoses& links, Side side) {
  const Pose& foot = links[At(FootSegmentOf(side))];
  const Pose& toe = links[At(FootSegmentOf(side) + 1)];
  return {foot.position + foot.orientation * skeleton.heel_in_foot[side],
          toe.position + toe.orientation * skeleton.toe_tip_in_toe[side]};
}

double LowestSolePoint(const Skeleton& skeleton, const LinkPoses& links) {
  double lowest = std::numeric_limits<double>::infinity();
  for (const Side side : {kRight, kLeft}) {
    for (const Vector3d& point : SolePoints(skeleton, links, side)) {
      lowest = std::min(lowest, point.z());
    }
  }
  return lowest;
}

Pose Interpolate(const Pose& a, const Pose& b, double t) {
  t = std::clamp(t, 0.0, 1.0);
  return {(1 - t) * a.position + t * b.position, a.orientation.slerp(t, b.orientation)};
}

LinkPoses Interpolate(const LinkPoses& a, const LinkPoses& b, double t) {
  LinkPoses between;
  for (std::size_t i = 0; i < between.size(); ++i) between[i] = Interpolate(a[i], b[i], t);
  return between;
}

}  // namespace kinescope::urdf
