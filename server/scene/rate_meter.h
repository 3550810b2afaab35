/// Measures the rate of a stream from the samples of one person: two people at 60 Hz are 60 Hz. One
/// thread.
#pragma once

#include <cstdint>
#include <optional>

#include "core/body_sample.h"

namespace kinescope::app {

class RateMeter {
 public:
  /// `nominal_hz`: the rate that a file states; 0 if it states none.
  explicit RateMeter(double nominal_hz) : nominal_hz_(nominal_hz) {}

  void Add(const BodySample& sample);
  /// The stream has stopped: the rate is 0, and is measured anew when samples return.
  void Stop();

  /// Samples per second over the last full second; 0 before it. A file: the stated rate, else that
  /// of its stamps.
  double hz() const { return hz_; }

 private:
  struct Window {
    std::int64_t start_nanos = 0;  // monotonic clock; for files, the clock of the stamps
    int character = 0;             // the person whose samples are counted
    int samples = 0;
  };

  const double nominal_hz_;
  double hz_ = 0;
  std::optional<Window> window_;
};

}  // namespace kinescope::app
