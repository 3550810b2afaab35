/// Estimates the rate of a motion from the first second of one person. Feed it, then read it; one
/// thread.
#pragma once

#include <cstdint>

#include "core/body_sample.h"
#include "server/mvn/inspect/frames.h"

namespace kinescope::app {

class BeginningRate {
 public:
  /// The next sample of the person.
  void Add(const BodySample& sample);

  /// Of the sample counters, from one sample to the next: a suit of 240 Hz that sends 60 samples
  /// per second counts 4, at 100 samples per second 2.4 on average. 1 if the counters do not tell.
  double counter_step() const { return frames_.usual_step(); }
  /// Samples per second, missing ones included; 0 for a single sample. Whole numbers where a clock
  /// trembles around one.
  double rate_hz() const;

 private:
  struct Instant {
    std::int64_t stamp_nanos = 0, time_code_millis = 0;
    std::uint32_t counter = 0;
  };

  double Secs() const;

  std::uint64_t samples_ = 0;
  Instant first_, last_;
  mvn::FrameTrack frames_{mvn::FrameTrack::Confirmation::kConfirmed};
};

}  // namespace kinescope::app
