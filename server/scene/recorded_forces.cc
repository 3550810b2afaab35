#include "server/scene/recorded_forces.h"

#include <fmt/format.h>

#include "core/system/clocks.h"
#include "core/system/errors.h"

namespace kinescope::app {
namespace {

using wrenches::BodyWrenches;
using wrenches::WrenchBody;

constexpr double kUsualRate = 60;                        // Hz
constexpr double kReachOfHand = 2;                       // m, as over ROS
constexpr std::int64_t kExpiredNanos = kNanosPerSecond;  // longer than a measurement is valid

constexpr std::array<WrenchBody, 2> kFeet = {WrenchBody::kRightFoot, WrenchBody::kLeftFoot};
constexpr std::array<WrenchBody, 2> kHands = {WrenchBody::kRightHand, WrenchBody::kLeftHand};

}  // namespace

RecordedForces::RecordedForces(const wrenches::WrenchSettings& settings, double rate_hz)
    : track_(settings), period_secs_(1 / (rate_hz > 0 ? rate_hz : kUsualRate)) {
  last_points_.fill(Eigen::Vector3d::Zero());
}

bool RecordedForces::AreOf(const BodySample& sample) {
  if (!character_) {
    character_ = sample.character;
    begin_nanos_ = sample.stamp_nanos;
  }
  return *character_ == sample.character;
}

Measurements RecordedForces::At(const BodySample& sample, const urdf::LinkPoses& links,
                                double floor_z) {
  const double secs = Secs(sample.stamp_nanos - begin_nanos_);
  const BodyWrenches found = track_.MeanAt(secs, period_secs_);
  Measurements measured;
  const auto ground = [&](WrenchBody body) -> std::optional<MeasuredGroundForce> {
    if (!found[wrenches::At(body)]) return std::nullopt;
    Eigen::Vector3d& last_point = last_points_[wrenches::At(body)];
    MeasuredGroundForce force = GroundForceOf(*found[wrenches::At(body)], floor_z, last_point);
    force.stamp_nanos = sample.stamp_nanos;
    last_point = force.point;
    return force;
  };
  measured.ground = ground(WrenchBody::kGround);
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    measured.feet[side] = ground(kFeet[side]);
    const WrenchBody body = kHands[side];
    if (!track_.Has(body)) continue;
    MeasuredHandForce& hand = measured.hands[side].emplace();
    if (!found[wrenches::At(body)]) {
      hand.stamp_nanos = sample.stamp_nanos - kExpiredNanos;
      continue;
    }
    hand = HandForceOf(*found[wrenches::At(body)]);
    hand.stamp_nanos = sample.stamp_nanos;
    if (!hand.point || hand.force.isZero(0)) continue;
    const double away = (*hand.point - links[urdf::At(urdf::HandSegmentOf(side))].position).norm();
    if (away < kReachOfHand) continue;
    throw SourceError(fmt::format(
        "{}: at {:.3f} s of the recording, the force on {} acts {:.1f} m from the hand; expected "
        "less than {} m; check --wrench_place and --wrench_offset",
        track_.path(), secs, Name(body), away, kReachOfHand));
  }
  return measured;
}

}  // namespace kinescope::app
