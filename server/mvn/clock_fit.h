/// Assigns each sample of a stream a wall-clock time that is free of network jitter.
///
/// The sender's clock (time code) gives exact intervals between samples; the receive time gives
/// absolute time, but with a varying delay. So: stamp = sender's clock + the smallest (receive time
/// - sender's clock) of the last 4 s. The sample with the shortest delay is stamped with its
/// receive time; every other sample gets an earlier stamp, by its extra delay. The window is short
/// because the two clocks drift (100 ppm make 0.4 ms in 4 s). A sender that plays a recording
/// slower than it was recorded drifts by far more; its drift is measured, and taken out first.
///
/// Time codes are whole milliseconds, which would give a stream of 240 Hz a jitter of a quarter of
/// its period. The sample counter is exact, so a line is fitted to the time codes along it. Stamps
/// of the first 32 samples may be most of a millisecond early.
///
/// A fit starts over when the time code jumps relative to the counter, and when the delay grows by
/// more than half a second (the sender paused). If a sender's time code does not advance, the
/// stamps are the receive times. The stamps of one stream always increase, by at least 0.1 ms,
/// unless the wall clock itself is set back. One thread.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "server/mvn/arrival.h"

namespace kinescope::mvn {

class ClockFit {
 public:
  /// Stamp (ns since the Unix epoch) of the next sample, whose first datagram arrived at `arrival`.
  /// Call it in the order of the sample counter.
  std::int64_t Stamp(std::uint32_t counter, std::uint32_t time_code_millis, const Arrival& arrival);

  /// Discards the fit: the sender's counter started over.
  void Restart();

 private:
  struct SenderClock {          // at the newest sample
    std::uint32_t samples = 0;  // since the start of the fit; no more than its memory
    std::uint32_t counter = 0;
    std::uint32_t millis = 0;
    double smooth_nanos = 0;   // time code without its rounding, ns
    double period_nanos = 0;   // of the counter, ns
    bool has_settled = false;  // minima_ are those of a line of many samples
  };

  void StartAt(std::uint32_t counter, std::uint32_t time_code_millis);
  void Advance(std::uint32_t counter, std::uint32_t time_code_millis);
  double SmallestOffset(double offset, std::int64_t now);
  void MeasureDrift();

  std::optional<SenderClock> clock_;
  struct Minimum {
    double offset = 0;
    double sender_nanos = 0;  // the sender's clock at it
    std::int64_t began = 0;   // of its quarter of a second; monotonic clock, ns
  };
  std::vector<Minimum> minima_;  // of each quarter of a second, the newest one at the end
  double drift_ = 0;             // of the offset, s per second of the sender's clock
  std::optional<std::int64_t> last_stamp_;
  std::int64_t last_wall_ = 0;
};

}  // namespace kinescope::mvn
