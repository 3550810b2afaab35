/// From the derivatives that a suit sends to those that loads are computed with: low-passed, in
/// limits, or zero with the reason where they cannot be had. A pure function of the samples in
/// order: no clocks. One thread; no allocation.
///
/// Source: joint-loads.md 2.3. Accelerations, angular ones and angular velocities go through one
/// and the same filter, so that what belongs together stays together in time: a causal Butterworth
/// low-pass of second order, in the trapezoidal state-variable form (V. Zavalishin, The Art of VA
/// Filter Design, 2012, ch. 4), which takes any step of time and gives the derivative of what it
/// filters as well.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/body_sample.h"
#include "server/loads/inverse_dynamics.h"

namespace kinescope::loads {

/// One step of time for any number of low-passes. `cutoff_hz` is lowered to 0.4 of the sample rate
/// where it is higher. @pre step_secs > 0
struct LowPassStep {
  LowPassStep(double step_secs, double cutoff_hz);
  double a1, a2, a3;    // of the implicit step
  double rate_of_band;  // 1/s
};

/// Of a vector. Starts steady at its first value.
class LowPass {
 public:
  void Restart(const Eigen::Vector3d& value);
  void Update(const Eigen::Vector3d& value, const LowPassStep& step);

  const Eigen::Vector3d& value() const { return value_; }
  const Eigen::Vector3d& rate() const { return rate_; }  // d value / dt, per s

 private:
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero(), rate_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d band_ = Eigen::Vector3d::Zero(), low_ = Eigen::Vector3d::Zero();  // state
};

class MotionFilter {
 public:
  struct Settings {
    bool dynamic = true;     // false: static by wish
    double cutoff_hz = 5.0;  // 3 to 10 makes sense
    double most_angular_acceleration =
        150;                         // rad/s^2, joint-loads.md 2.3; longer ones are cut to it
    double longest_gap_secs = 0.25;  // a longer one starts the filter afresh
  };

  struct Output {
    bool is_dynamic = false;
    std::string_view why_static;  // "" while dynamic; static lifetime
    BodyMotion motion{};          // zeros while static
  };

  /// Reads stamp and derivatives of `sample`. Streamed accelerations are filtered. Where a sender
  /// leaves them at zero while velocities move, the filtered velocities are differentiated. A step
  /// back in time or a long gap starts afresh; the same stamp again changes nothing. A sample
  /// without derivatives amid others that have them (a lost datagram) leaves the output as it was,
  /// for as long as a gap may be.
  ///
  /// Static, with the reason: no derivatives; linear without angular or the reverse; numbers that
  /// are not finite; accelerations that cannot be: those which over the last second add up to
  /// another change of velocity than the one streamed (gravity left in), or angular velocities that
  /// turn the body much farther than it turned (degrees).
  const Output& Update(const BodySample& sample, const Settings& settings);

 private:
  struct Channels {
    LowPass acceleration, angular_velocity, angular_acceleration;
    LowPass velocity;  // differentiated where no acceleration is streamed
  };
  void Restart(const BodySample& sample);
  void Filter(const BodySample& sample, const LowPassStep& step);
  void Compare(const BodySample& sample, double step_secs);
  std::string_view Doubt() const;
  void Fill(const Settings& settings);
  const Output& BecomeStatic(std::string_view why);

  std::array<Channels, urdf::kSegmentCount> channels_;
  bool has_last_ = false;
  bool linear_is_streamed_ = false, angular_is_streamed_ = false;  // an acceleration was not zero
  std::int64_t last_nanos_ = 0;
  // What Doubt judges: sums that forget within about a second.
  std::array<Eigen::Quaterniond, urdf::kSegmentCount> last_orientation_;
  Eigen::Vector3d last_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_excess_ = Eigen::Vector3d::Zero();  // m/s, mean of the segments
  double turned_ = 0, claimed_turn_ = 0;                       // rad, sum over the segments
  Output output_;
};

}  // namespace kinescope::loads
