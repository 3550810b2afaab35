/// Filters the motion of a recorded person without lag: a Butterworth low-pass of second order,
/// forward and backward. With both passes, the gain is 1/sqrt(2) at the cut-off frequency. Ends are
/// extended by nine samples, mirrored about the end point, as SciPy's filtfilt does. One object per
/// person; one thread.
///
/// Source: biomech-files.md B.1. A motion comes out up to two seconds later than it goes in: the
/// backward pass starts a second ahead, where its initial state has no effect any more.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "core/body_sample.h"
#include "server/loads/inverse_dynamics.h"
#include "server/loads/motion_filter.h"

namespace kinescope::loads {

class ZeroPhaseFilter {
 public:
  explicit ZeroPhaseFilter(double cutoff_hz) : cutoff_hz_(cutoff_hz) {}

  /// Adds the derivatives of the next sample. Accelerations that a sender leaves at zero are
  /// derived from its velocities.
  /// @pre the stamp is above the last one since End(); WhatIsMissing(sample) is ""
  void Add(const BodySample& sample);
  /// No sample continues the motion: a gap, or the end of the recording.
  void End();

  /// Motions that are ready, in the order of the samples, to be taken from the front.
  std::deque<BodyMotion>& ready() { return ready_; }

 private:
  enum Kind { kAcceleration, kAngularVelocity, kAngularAcceleration, kVelocity, kKinds };
  static constexpr std::size_t kChannels = std::size_t{urdf::kSegmentCount} * kKinds;
  using Values = std::array<Eigen::Vector3d, kChannels>;
  using Bank = std::array<LowPass, kChannels>;
  struct Moment {
    std::int64_t stamp_nanos = 0;
    Values raw, forward;
  };

  void Pass(const Values& values, double secs, Bank& bank) const;
  static void Restart(const Values& values, Bank& bank);
  static Values ValuesOf(const Bank& bank);
  double StepBefore(std::size_t moment) const;  // s
  void Start();
  std::vector<Values> Backward(bool has_ended) const;
  void Emit(std::size_t count, const std::vector<Values>& values);

  double cutoff_hz_;
  std::deque<Moment> moments_;  // not out yet
  bool has_started_ = false;    // all of moments_ have passed forward
  Bank state_;                  // of the forward pass
  bool linear_is_streamed_ = false, angular_is_streamed_ = false;
  std::optional<Moment> last_out_;  // `forward` is what came out
  std::deque<BodyMotion> ready_;
};

}  // namespace kinescope::loads
