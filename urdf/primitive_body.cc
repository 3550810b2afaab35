#include "urdf/primitive_body.h"

#include <cmath>

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;
using PrimitiveKind = Primitive::Kind;

// A cylinder from `from` to `to`.
Primitive Rod(const Vector3d& from, const Vector3d& to, double radius) {
  const Vector3d axis = to - from;
  const Vector3d unit = axis.normalized();
  Primitive rod;
  rod.kind = PrimitiveKind::kCylinder;
  rod.size = {radius, axis.norm(), 0};
  rod.center = 0.5 * (from + to);
  // Turns z onto the axis: first about x, then about y (fixed axes, as URDF's rpy).
  rod.rpy = {std::asin(-unit.y()), std::atan2(unit.x(), unit.z()), 0};
  return rod;
}

Primitive Ball(const Vector3d& center, double radius) {
  return {PrimitiveKind::kSphere, {radius, 0, 0}, center, Vector3d::Zero()};
}

// A box around the line from the origin to `end`, which is mostly along z.
Primitive TrunkBox(const Vector3d& end, double depth, double width) {
  return {PrimitiveKind::kBox, {depth, width, std::abs(end.z())}, 0.5 * end, Vector3d::Zero()};
}

// The same on a hinge across the joint, so that a spine that bends shows no gap. A little thinner
// than the box, so that no two faces are one.
std::vector<Primitive> Vertebra(const Vector3d& end, double depth, double width) {
  const Vector3d side(0, 0.49 * width, 0);
  return {TrunkBox(end, depth, width), Rod(-side, side, 0.49 * depth)};
}

// A limb with rounded ends, so that bent joints show no gap.
std::vector<Primitive> Limb(const Vector3d& end, double radius) {
  return {Rod(Vector3d::Zero(), end, radius), Ball(Vector3d::Zero(), radius), Ball(end, radius)};
}

}  // namespace

std::vector<Primitive> PrimitiveBody(const Skeleton& skeleton, int segment) {
  const double h = skeleton.height;  // girths are fractions of stature, by eye
  const Vector3d end = EndOf(skeleton, segment);
  switch (segment) {
    case kPelvis: {
      Primitive box = TrunkBox(end, 0.105 * h, 0.19 * h);
      box.size.z() += 0.03 * h;
      return {box};
    }
    case kL5: return Vertebra(end, 0.105 * h, 0.175 * h);
    case kL3: return Vertebra(end, 0.105 * h, 0.165 * h);
    case kT12: return Vertebra(end, 0.115 * h, 0.170 * h);
    case kT8: return Vertebra(end, 0.120 * h, 0.185 * h);
    case kNeck: return Limb(end, 0.032 * h);
    case kHead: {
      const double radius = 0.5 * std::abs(end.z());
      return {Ball(0.5 * end, radius), Ball({0.55 * radius, 0, 0.75 * radius}, 0.55 * radius)};
    }
    case kRightShoulder:
    case kLeftShoulder: return Limb(end, 0.032 * h);
    case kRightUpperArm:
    case kLeftUpperArm: return Limb(end, 0.027 * h);
    case kRightForeArm:
    case kLeftForeArm: return Limb(end, 0.022 * h);
    case kRightHand:
    case kLeftHand: {
      Primitive palm = {PrimitiveKind::kBox,
                        {0.045 * h, 0.017 * h, 0.9 * std::abs(end.z())},
                        0.5 * end,
                        Vector3d::Zero()};
      return {palm, Ball(Vector3d::Zero(), 0.019 * h)};
    }
    case kRightUpperLeg:
    case kLeftUpperLeg: return Limb(end, 0.043 * h);
    case kRightLowerLeg:
    case kLeftLowerLeg: return Limb(end, 0.030 * h);
    case kRightFoot:
    case kLeftFoot: {
      const Side side = segment == kRightFoot ? kRight : kLeft;
      const Vector3d heel = skeleton.heel_in_foot[side];
      const double bottom = heel.z();
      const double top = 0.4 * bottom;
      return {{PrimitiveKind::kBox,
               {end.x() - heel.x(), 0.052 * h, top - bottom},
               {0.5 * (end.x() + heel.x()), 0, 0.5 * (top + bottom)},
               Vector3d::Zero()},
              Ball(Vector3d::Zero(), 0.026 * h)};
    }
    default: {
      const Side side = segment == kRightToe ? kRight : kLeft;
      const Vector3d tip = skeleton.toe_tip_in_toe[side];
      const double thickness = std::max(0.012 * h, 2 * std::abs(tip.z()));
      return {{PrimitiveKind::kBox,
               {tip.x(), 0.052 * h, thickness},
               {0.5 * tip.x(), 0, 0.0},
               Vector3d::Zero()}};
    }
  }
}

}  // namespace kinescope::urdf
