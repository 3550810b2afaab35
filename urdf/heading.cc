#include "urdf/heading.h"

#include <cmath>

namespace kinescope::urdf {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Forward and the left side turned forward, each by how level it is: one of them is, unless the
// trunk is upside down. At most 2 long.
Vector2d ForwardOf(const Eigen::Quaterniond& segment) {
  const Vector3d forward = segment * Vector3d::UnitX(), left = segment * Vector3d::UnitY();
  const Vector2d from_forward = forward.head<2>();
  const Vector2d from_left(left.y(), -left.x());
  return from_forward.norm() * from_forward + from_left.norm() * from_left;
}

double AngleOf(const Vector2d& direction) { return std::atan2(direction.y(), direction.x()); }

}  // namespace

Heading HeadingOf(const LinkPoses& links) {
  constexpr double kLying = 0.35;     // the trunk's axis is this level
  constexpr double kUndefined = 0.5;  // length of the direction below which it means nothing
  const Eigen::Quaterniond& pelvis = links[kPelvis].orientation;
  const Eigen::Quaterniond& chest = links[kT8].orientation;
  const auto is_level = [](const Eigen::Quaterniond& segment) {
    return std::abs((segment * Vector3d::UnitZ()).z()) < kLying;
  };
  if (is_level(pelvis) && is_level(chest)) {
    // A bent trunk is level, too, but the legs below it are not.
    const Vector3d legs = links[kRightLowerLeg].position + links[kLeftLowerLeg].position -
                          links[kRightUpperLeg].position - links[kLeftUpperLeg].position;
    if (std::abs(legs.z()) < 0.6 * legs.norm()) {
      const Vector2d axis = (chest * Vector3d::UnitZ()).head<2>().normalized();
      const auto across = [&](const Vector3d& direction) {
        const Vector2d level = (chest * direction).head<2>();
        return Vector2d(level - level.dot(axis) * axis);
      };
      const Vector2d face = across(Vector3d::UnitX());
      if (face.norm() > kLying) return {HeadingRule::kLyingOnSide, AngleOf(face)};
      return {HeadingRule::kLyingLevel, AngleOf(across(Vector3d::UnitY()))};
    }
  }
  const Vector2d forward = 0.5 * (ForwardOf(pelvis) + ForwardOf(chest));
  if (forward.norm() < kUndefined) return {};
  return {HeadingRule::kUpright, AngleOf(forward)};
}

}  // namespace kinescope::urdf
