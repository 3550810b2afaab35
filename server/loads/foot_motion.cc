#include "server/loads/foot_motion.h"

#include <optional>

#include "core/system/clocks.h"
#include "server/loads/gap.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;
using urdf::At;
using urdf::kLeft;
using urdf::kRight;
using urdf::Side;

// Absent where the sender left zeros in the place of velocities.
std::optional<Vector3d> StreamedVelocity(const BodySample& sample, std::size_t segment,
                                         const Vector3d& point) {
  const SegmentState& state = sample.segments[segment];
  const bool is_streamed = sample.has_linear && sample.has_angular && state.velocity.allFinite() &&
                           state.angular_velocity.allFinite() &&
                           !(state.velocity.isZero(0) && state.angular_velocity.isZero(0));
  if (!is_streamed) return std::nullopt;
  return Vector3d(state.velocity + state.angular_velocity.cross(point - state.position));
}

}  // namespace

void FootMotion::Update(const BodySample& sample, const urdf::LinkPoses& links,
                        const urdf::Skeleton& skeleton) {
  const double step_secs = Secs(sample.stamp_nanos - last_nanos_);
  if (has_last_ && step_secs == 0) return;
  if (!has_last_ || step_secs < 0 || step_secs > kLongestGapSecs) fit_.Restart();
  has_last_ = true;
  last_nanos_ = sample.stamp_nanos;
  for (const Side side : {kRight, kLeft}) {
    const auto [heel, tip] = urdf::SolePoints(skeleton, links, side);
    points_[Index(side, kHeelPoint)] = heel;
    points_[Index(side, kBallPoint)] = links[At(urdf::FootSegmentOf(side)) + 1].position;
    points_[Index(side, kTipPoint)] = tip;
  }
  fit_.Add(sample.stamp_nanos, points_);
  for (const Side side : {kRight, kLeft}) {
    const std::size_t foot = At(urdf::FootSegmentOf(side));
    for (const FootPoint point : {kHeelPoint, kBallPoint, kTipPoint}) {
      const std::size_t index = Index(side, point);
      auto velocity =
          StreamedVelocity(sample, point == kHeelPoint ? foot : foot + 1, points_[index]);
      if (!velocity) velocity = fit_.Of(index);
      speeds_[index] = velocity ? velocity->norm() : 0.0;
    }
  }
}

}  // namespace kinescope::loads
