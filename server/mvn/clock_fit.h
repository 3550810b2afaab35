/// Gives each sample of one stream a time on our wall clock that the network's jitter does not
/// shake.
///
/// The sender's clock (time code) tells exactly how far apart samples are; the arrival tells when
/// they are, but late by a delay that varies. So: stamp = sender's clock + the smallest
/// (arrival - sender's clock) of the last 2 to 4 s. The sample that had the fastest way is stamped
/// with its arrival, every other one earlier, by as much as it was held up. The window is
/// short because the two clocks drift (100 ppm make 0.4 ms in 4 s).
///
/// Time codes are whole milliseconds, which would shake a stream of 240 Hz by a quarter of its
/// period. The sample counter is exact, so time codes are smoothed along it.
///
/// Fits start afresh when the time code jumps against the counter, and when the delay grows by more
/// than half a second (the sender paused). A sender whose time code stands still gets its arrival
/// times as stamps. Stamps of one stream always increase, by at least 0.1 ms, unless the wall
/// clock itself was set back. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "server/mvn/arrival.h"

namespace kinescope::mvn {

class ClockFit {
 public:
  /// Stamp (ns since the Unix epoch) of the next sample, whose first datagram came at `arrival`.
  /// Samples in order of their counter.
  std::int64_t Stamp(std::uint32_t counter, std::uint32_t time_code_millis, const Arrival& arrival);

  /// Forgets the sender's clock: its counter started over.
  void Restart();

 private:
  struct SenderClock {                // of the newest sample
    std::uint32_t first_counter = 0;  // where the fit began
    std::uint32_t first_millis = 0;
    std::uint32_t counter = 0;
    std::uint32_t millis = 0;
    double smooth_nanos = 0;  // time code without its rounding
  };

  void StartAt(std::uint32_t counter, std::uint32_t time_code_millis);
  void Advance(std::uint32_t counter, std::uint32_t time_code_millis);
  double SmallestOffset(double offset, std::int64_t now);

  std::optional<SenderClock> clock_;
  struct Minimum {
    double offset = 0;
    std::int64_t began = 0;  // monotonic
  };
  std::optional<Minimum> current_;   // of the running 2 s
  std::optional<Minimum> previous_;  // of the 2 s before
  std::optional<std::int64_t> last_stamp_;
  std::int64_t last_wall_ = 0;
};

}  // namespace kinescope::mvn
