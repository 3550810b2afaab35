/// Computes the forces on the hands from the masses that they hold and from measured forces
/// (joint-loads.md 2.7). The result depends only on the samples in order. One thread; no
/// allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "core/body_forces.h"
#include "core/force_inputs.h"
#include "server/loads/inverse_dynamics.h"
#include "urdf/skeleton.h"

namespace kinescope::loads {

constexpr double kMaxHeldKg = 100;  // a larger value is a typing error

using kinescope::HandLoad;
using kinescope::MeasuredHandForce;

/// Why `load` is invalid, with the hand, the value and the expected range; "" if it is valid.
/// Invalid: a mass that is negative, not a number or in sum above kMaxHeldKg; a CoM more than 2 m
/// from the hand.
[[nodiscard]] std::string FindDefect(const HandLoad& load);

/// "right:5", "left:2.5", "both:10", "right:5@0,0,-0.2" (CoM in the hand's link frame, m), or
/// several separated by semicolons; "none": empty hands.
/// @throws UsageError with `text`, the invalid part and the expected form.
HandLoad ParseHandLoad(const std::string& text);

/// Time for which a measurement is valid, s (joint-loads.md 5.7).
constexpr double kFreshSecs = 0.5;
bool IsFresh(std::int64_t measured_nanos, std::int64_t sample_nanos);

class HandLoads {
 public:
  /// Advances to `stamp_nanos`: the ramps move towards `load`. The first call, and one after more
  /// than half a second or a step back, sets `load` at once.
  void Update(const HandLoad& load, std::int64_t stamp_nanos);

  /// Adds to `external` the weight and inertia of the current hand loads, for the given motion of
  /// the hands, and the measured forces that have not expired.
  void Push(const urdf::LinkPoses& links, const BodyMotion& motion, const urdf::Skeleton& skeleton,
            const std::array<std::optional<MeasuredHandForce>, 2>& measured,
            std::int64_t stamp_nanos, ExternalForces& external,
            std::array<HandForce, 2>& shown) const;

 private:
  /// A mass that changes linearly over the ramp, kg.
  struct Ramp {
    double now = 0, from = 0, to = 0;
    double secs = 0;  // time since its start
    void Restart(double value);
    void Step(double target, double step_secs);
  };
  std::array<Ramp, 2> single_;
  Ramp both_;
  HandLoad load_;  // the newest; for an emptied hand, the CoM before
  bool has_last_ = false;
  std::int64_t last_nanos_ = 0;
};

}  // namespace kinescope::loads
