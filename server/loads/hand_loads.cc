#include "server/loads/hand_loads.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "server/loads/gap.h"
#include "urdf/placed_mass.h"

namespace kinescope::loads {
namespace {

using Eigen::Vector3d;
using urdf::At;
using urdf::kLeft;
using urdf::kRight;
using urdf::Side;

constexpr double kRampSecs = 0.3;
constexpr double kFarthest = 2;  // m, of a CoM from its hand

constexpr std::array<const char*, 2> kSideName = {"right", "left"};

bool IsMass(double mass_kg) { return mass_kg >= 0 && mass_kg <= kMaxHeldKg; }

std::string MassDefect(const char* where, double mass_kg) {
  return fmt::format("load of {} kg in {}: expected 0 to {} kg", mass_kg, where, kMaxHeldKg);
}

// Share of the right hand in a load that both hands hold (joint-loads.md 2.7).
double RightShare(const Vector3d& object, const Vector3d& right, const Vector3d& left) {
  constexpr double kClosest = 0.05;  // m; hands that touch share equally
  const Vector3d apart = right - left;
  if (apart.norm() < kClosest) return 0.5;
  return std::clamp((object - left).dot(apart) / apart.squaredNorm(), 0.0, 1.0);
}

}  // namespace

std::string FindDefect(const HandLoad& load) {
  for (const Side side : {kRight, kLeft}) {
    if (!IsMass(load.mass_kg[side])) {
      return MassDefect((std::string("the ") + kSideName[side] + " hand").c_str(),
                        load.mass_kg[side]);
    }
    if (load.com_in_hand[side] && !(load.com_in_hand[side]->norm() <= kFarthest)) {
      const Vector3d& at = *load.com_in_hand[side];
      return fmt::format("load in the {} hand at ({}, {}, {}) m: expected within {} m of the wrist",
                         kSideName[side], at.x(), at.y(), at.z(), kFarthest);
    }
  }
  if (!IsMass(load.both_kg)) return MassDefect("both hands", load.both_kg);
  if (const double sum = load.mass_kg[kRight] + load.mass_kg[kLeft] + load.both_kg; !IsMass(sum)) {
    return MassDefect("all hands together", sum);
  }
  if (load.both_com_in_world && !load.both_com_in_world->allFinite()) {
    return "position of the load in both hands: expected three finite numbers";
  }
  return "";
}

HandLoad ParseHandLoad(const std::string& text) try {
  HandLoad load;
  load.is_known = true;
  if (text == "none") return load;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    const urdf::PlacedMass placed = urdf::ParsePlacedMass(text.substr(begin, end - begin));
    if (placed.where == "both") {
      if (placed.position) throw std::invalid_argument("both:KG takes no position");
      load.both_kg = placed.mass_kg;
    } else if (placed.where == kSideName[kRight] || placed.where == kSideName[kLeft]) {
      const Side side = placed.where == kSideName[kRight] ? kRight : kLeft;
      load.mass_kg[side] = placed.mass_kg;
      load.com_in_hand[side] = placed.position;
    } else {
      throw std::invalid_argument("unknown hand '" + placed.where + "'");
    }
    begin = end + 1;
  }
  if (const std::string defect = FindDefect(load); !defect.empty()) {
    throw std::invalid_argument(defect);
  }
  return load;
} catch (const std::invalid_argument& error) {
  throw UsageError(
      fmt::format("{}; expected right:KG, left:KG or both:KG, comma-separated; right:KG@X,Y,Z "
                  "if the centre of mass is not at the grip (m, in the hand's link frame); or none",
                  error.what()));
}

bool IsFresh(std::int64_t measured_nanos, std::int64_t sample_nanos) {
  // The same limit for future and past stamps, because the clocks are those of two computers.
  return std::abs(static_cast<double>(sample_nanos - measured_nanos)) * 1e-9 <= kFreshSecs;
}

void HandLoads::Ramp::Restart(double value) {
  now = from = to = value;
  secs = 0;
}

void HandLoads::Ramp::Step(double target, double step_secs) {
  if (target != to) {
    from = now;
    to = target;
    secs = 0;
  }
  secs += step_secs;
  now = secs >= kRampSecs ? to : from + (to - from) * secs / kRampSecs;
}

void HandLoads::Update(const HandLoad& load, std::int64_t stamp_nanos) {
  const double step_secs = Secs(stamp_nanos - last_nanos_);
  const bool fresh = !has_last_ || step_secs < 0 || step_secs > kLongestGapSecs;
  for (const Side side : {kRight, kLeft}) {
    const double mass = load.mass_kg[side];
    if (mass > 0 || fresh) load_.com_in_hand[side] = load.com_in_hand[side];
    fresh ? single_[side].Restart(mass) : single_[side].Step(mass, step_secs);
  }
  if (load.both_kg > 0 || fresh) load_.both_com_in_world = load.both_com_in_world;
  fresh ? both_.Restart(load.both_kg) : both_.Step(load.both_kg, step_secs);
  has_last_ = true;
  last_nanos_ = stamp_nanos;
}

void HandLoads::Push(const urdf::LinkPoses& links, const BodyMotion& motion,
                     const urdf::Skeleton& skeleton,
                     const std::array<std::optional<MeasuredHandForce>, 2>& measured,
                     std::int64_t stamp_nanos, ExternalForces& external,
                     std::array<HandForce, 2>& shown) const {
  const Vector3d up(0, 0, kGravity);
  std::array<Vector3d, 2> grip, grip_acceleration;
  for (const Side side : {kRight, kLeft}) {
    const std::size_t hand = At(urdf::HandSegmentOf(side));
    const Vector3d arm = links[hand].orientation * urdf::GripPoint(skeleton, side);
    grip[side] = links[hand].position + arm;
    grip_acceleration[side] = AccelerationAt(motion[hand], arm);
  }
  const Vector3d object = load_.both_com_in_world.value_or(0.5 * (grip[kRight] + grip[kLeft]));
  const double right_share = RightShare(object, grip[kRight], grip[kLeft]);
  const Vector3d object_acceleration =
      right_share * grip_acceleration[kRight] + (1 - right_share) * grip_acceleration[kLeft];

  for (const Side side : {kRight, kLeft}) {
    const int hand = urdf::HandSegmentOf(side);
    HandForce& all = shown[side];
    all = {};
    all.point = all.grip = grip[side];
    const auto push = [&](const Vector3d& force, const Vector3d& point, const Vector3d& moment) {
      external.Push(links, hand, force, point, moment);
      if (all.force.isZero(0)) all.point = point;
      all.force += force;
    };
    if (const double mass = single_[side].now; mass > 0) {
      const Vector3d arm = links[At(hand)].orientation *
                           load_.com_in_hand[side].value_or(urdf::GripPoint(skeleton, side));
      push(-mass * (AccelerationAt(motion[At(hand)], arm) + up), links[At(hand)].position + arm,
           Vector3d::Zero());
      all.mass_kg += mass;
    }
    const double part = both_.now * (side == kRight ? right_share : 1 - right_share);
    if (part > 0) {
      push(-part * (object_acceleration + up), grip[side], Vector3d::Zero());
      all.mass_kg += part;
      all.shared_kg = part;
    }
    if (measured[side] && IsFresh(measured[side]->stamp_nanos, stamp_nanos)) {
      push(measured[side]->force, measured[side]->point.value_or(grip[side]),
           measured[side]->moment);
      all.is_measured = true;
    }
  }
}

}  // namespace kinescope::loads
