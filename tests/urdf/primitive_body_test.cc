#include "urdf/primitive_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "urdf/kinematics.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

bool Contains(const Primitive& primitive, const Vector3d& point) {
  const Eigen::Quaterniond turn =
      Eigen::AngleAxisd(primitive.rpy.z(), Vector3d::UnitZ()) *
      Eigen::AngleAxisd(primitive.rpy.y(), Vector3d::UnitY()) *
      Eigen::Quaterniond(Eigen::AngleAxisd(primitive.rpy.x(), Vector3d::UnitX()));
  const Vector3d at = turn.conjugate() * (point - primitive.center);
  constexpr double kRounding = 1e-9;
  switch (primitive.kind) {
    case Primitive::Kind::kBox:
      return ((0.5 * primitive.size - at.cwiseAbs()).array() > -kRounding).all();
    case Primitive::Kind::kSphere: return at.norm() < primitive.size.x() + kRounding;
    case Primitive::Kind::kCylinder:
      return at.head<2>().norm() < primitive.size.x() + kRounding &&
             std::abs(at.z()) < 0.5 * primitive.size.y() + kRounding;
  }
  return false;
}

bool Contains(const std::vector<Primitive>& primitives, const Vector3d& point) {
  return std::any_of(primitives.begin(), primitives.end(),
                     [&](const Primitive& each) { return Contains(each, point); });
}

// From the belly to the back, across the joint, nothing opens that one could see through.
TEST(PrimitiveBody, HasNoGapInABentSpine) {
  const Skeleton skeleton = DefaultSkeleton();
  constexpr double kDeep = 0.085;  // m, from the axis: nearly to the surface
  for (const int joint : {jL5S1, jL4L3, jL1T12, jT9T8}) {
    const std::vector<Primitive> parent = PrimitiveBody(skeleton, ParentOf(joint));
    const std::vector<Primitive> child = PrimitiveBody(skeleton, ChildOf(joint));
    const Vector3d& center = skeleton.origin_in_parent[At(ChildOf(joint))];
    for (double flexion = -0.5; flexion <= 0.5; flexion += 0.125) {
      const Eigen::Quaterniond child_from_parent =
          RotationFromAngles(Vector3d(0, flexion, 0)).conjugate();
      for (int step = 0; step < 24; ++step) {
        const double angle = 2 * M_PI * step / 24;
        for (const double side : {-0.1, 0.0, 0.1}) {
          const Vector3d offset(kDeep * std::cos(angle), side, kDeep * std::sin(angle));
          EXPECT_TRUE(Contains(parent, center + offset) ||
                      Contains(child, child_from_parent * offset))
              << kJoints[At(joint)].mvn_name << " bent by " << flexion << " rad gapes at "
              << offset.transpose();
        }
      }
    }
  }
}

}  // namespace
}  // namespace kinescope::urdf
