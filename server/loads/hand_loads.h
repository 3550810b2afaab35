/// What the hands hold, and what sensors say about them: from masses and measured forces to forces
/// on the hands (joint-loads.md 2.7). A pure function of the samples in order. One thread; no
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

constexpr double kMostHeldKg = 100;  // more is a typing error

using kinescope::HandLoad;
using kinescope::MeasuredHandForce;

/// "" or what is wrong with `load`, naming the hand, the value and what is expected: a mass that is
/// negative, not a number or above kMostHeldKg in sum; a CoM farther than 2 m from the hand.
[[nodiscard]] std::string FindDefect(const HandLoad& load);

/// "right:5", "left:2.5", "both:10", "right:5@0,0,-0.2" (CoM in the hand's link frame, m), or
/// several with semicolons; "none": nothing, for certain.
/// @throws UsageError naming `text`, the part that is wrong and what is expected.
HandLoad ParseHandLoad(const std::string& text);

/// Measurements count this long, seconds (joint-loads.md 5.7).
constexpr double kFreshSecs = 0.5;
bool IsFresh(std::int64_t measured_nanos, std::int64_t sample_nanos);

class HandLoads {
 public:
  /// Takes a step of time to `stamp_nanos`: ramps move towards `load`. The first, one after more
  /// than half a second or backwards: at once.
  void Update(const HandLoad& load, std::int64_t stamp_nanos);

  /// Adds the weight and inertia of what is held now, for hands that move so, and the measured
  /// forces that are fresh, to `external`.
  void Push(const urdf::LinkPoses& links, const BodyMotion& motion, const urdf::Skeleton& skeleton,
            const std::array<std::optional<MeasuredHandForce>, 2>& measured,
            std::int64_t stamp_nanos, ExternalForces& external,
            std::array<HandForce, 2>& shown) const;

 private:
  /// A mass on its way: linear over the ramp.
  struct Ramp {
    double now = 0, from = 0, to = 0;
    double secs = 0;  // since it began
    void Restart(double value);
    void Step(double target, double step_secs);
  };
  std::array<Ramp, 2> single_;
  Ramp both_;
  HandLoad load_;  // the newest; where a hand lets go, the CoM of before
  bool has_last_ = false;
  std::int64_t last_nanos_ = 0;
};

}  // namespace kinescope::loads
