/// Prepares the streamed derivatives for the load computation: low-pass filtered and limited, or
/// zero with the reason if they are not available. The result depends only on the samples in order
/// and not on clocks. One thread; no allocation.
///
/// Source: joint-loads.md 2.3. Linear and angular accelerations and angular velocities pass through
/// the same filter, so that they stay aligned in time: a causal Butterworth low-pass of second
/// order, in the trapezoidal state-variable form (V. Zavalishin, The Art of VA Filter Design, 2012,
/// ch. 4), which accepts any time step and also gives the derivative of the filtered signal.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string_view>

#include "core/body_sample.h"
#include "server/loads/inverse_dynamics.h"

namespace kinescope::loads {

/// Coefficients of one time step for any number of low-passes. `cutoff_hz` is limited to 0.4 of the
/// sample rate. @pre step_secs > 0
struct LowPassStep {
  LowPassStep(double step_secs, double cutoff_hz) : LowPassStep(step_secs, cutoff_hz, 1) {}
  /// Of one of two passes, which together have the gain 1/sqrt(2) at the cut-off (biomech-files.md
  /// B.1).
  static LowPassStep OfTwoPasses(double step_secs, double cutoff_hz);
  double a1, a2, a3;    // of the implicit step
  double rate_of_band;  // 1/s

 private:
  LowPassStep(double step_secs, double cutoff_hz, double correction);
};

/// By how much the low-pass delays slow motion, s.
double DelayOf(double step_secs, double cutoff_hz);

/// Why a sample has no motion to filter: "the source sends only poses"; "" if it has.
std::string_view WhatIsMissing(const BodySample& sample);

/// Low-pass of a vector. Starts in the steady state of its first value.
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
    bool dynamic = true;                // false: static by option
    double cutoff_hz = 5.0;             // of a stream
    double recording_cutoff_hz = 10.0;  // of ZeroPhaseFilter, which MotionFilter does not use
    double most_angular_acceleration =
        1000;                        // rad/s^2, more than in a kick; longer vectors are shortened
    double longest_gap_secs = 0.25;  // the filter starts over after a longer gap
  };

  struct Output {
    bool is_dynamic = false;
    std::string_view why_static;  // "" while dynamic; lives as long as the program
    double delay_secs = 0;        // of `motion`, for slow motion
    BodyMotion motion{};          // zeros while static
  };

  /// Adds a sample: its stamp and derivatives. Streamed accelerations are filtered. If a sender
  /// leaves them at zero while velocities change, the filtered velocities are differentiated. A
  /// step back in time or a long gap starts over; a repeated stamp changes nothing. A sample
  /// without derivatives among others that have them (a lost datagram) keeps the output, at most
  /// for the longest gap.
  ///
  /// Static, with the reason: no derivatives; linear without angular ones or the reverse; numbers
  /// that are not finite; implausible accelerations: their sum over the last second differs from
  /// the change of the streamed velocity (gravity included), or the angular velocities rotate the
  /// body much farther than it rotated (degrees).
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
  bool linear_is_streamed_ = false, angular_is_streamed_ = false;  // an acceleration other than
                                                                   // zero was received
  std::int64_t last_nanos_ = 0;
  // Input of Doubt: sums with a memory of about a second.
  std::array<Eigen::Quaterniond, urdf::kSegmentCount> last_orientation_;
  Eigen::Vector3d last_velocity_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_excess_ = Eigen::Vector3d::Zero();  // m/s, mean of the segments
  double turned_ = 0, claimed_turn_ = 0;                       // rad, sum over the segments
  Output output_;
};

}  // namespace kinescope::loads
