#include "server/loads/ground.h"

#include <algorithm>

#include "core/system/check.h"

namespace kinescope::loads {

using Eigen::Vector2d;
using Eigen::Vector3d;
using urdf::kLeft;
using urdf::kRight;

std::optional<CenterOfPressure> FindCenterOfPressure(const Wrench& ground, double floor_z,
                                                     double mass_kg) {
  constexpr double kMinShareOfWeight = 0.1;
  const Vector3d& f = ground.force;
  const Vector3d& m = ground.moment;
  if (!(f.z() >= kMinShareOfWeight * mass_kg * kGravity)) return std::nullopt;
  CenterOfPressure cop;
  cop.point = {(floor_z * f.x() - m.y()) / f.z(), (m.x() + floor_z * f.y()) / f.z()};
  cop.free_moment = m.z() - (cop.point.x() * f.y() - cop.point.y() * f.x());
  return cop;
}

GroundSplit SplitGround(const Vector3d& force, const CenterOfPressure& cop,
                        const std::array<FootOnGround, 2>& feet) {
  const FootOnGround& right = feet[kRight];
  const FootOnGround& left = feet[kLeft];
  KINESCOPE_CHECK(right.weight + left.weight > 0);
  constexpr double kClosest = 0.05;  // m; nearer feet share equally
  const Vector2d apart = right.center - left.center;
  double share = 0.5;
  if (apart.norm() >= kClosest) {
    share = std::clamp((cop.point - left.center).dot(apart) / apart.squaredNorm(), 0.0, 1.0);
  }
  const double right_part = share * right.weight;
  const double left_part = (1 - share) * left.weight;
  if (right_part + left_part > 0) {
    share = right_part / (right_part + left_part);
  } else {  // the CoP is at a foot without contact
    share = right.weight > left.weight ? 1.0 : 0.0;
  }
  const Vector2d offset = cop.point - ((1 - share) * left.center + share * right.center);
  GroundSplit split;
  split.right_share = share;
  split.feet[kRight] = {share * force, right.center + offset, share * cop.free_moment};
  split.feet[kLeft] = {(1 - share) * force, left.center + offset, (1 - share) * cop.free_moment};
  return split;
}

}  // namespace kinescope::loads
