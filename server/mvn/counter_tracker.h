/// What the sample counter of one stream says about the next datagram. The counter counts captured
/// frames: a stream slower than the capture steps by more than one, always by about the same. One
/// thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace kinescope::mvn {

class CounterTracker {
 public:
  enum class Order {
    kSame,     // of the newest sample
    kNewer,    // of a sample after it
    kLate,     // of a sample before it
    kRestart,  // the sender started counting anew; this is the newest sample now
  };

  /// Where `counter` stands, seen at `now_nanos` (monotonic). A lower counter is a restart when it
  /// is lower by more than any network reorders, or when the newer one has been silent for a
  /// quarter of a second, or when lower counters keep coming, in order, and newer ones do not.
  Order Take(std::uint32_t counter, std::int64_t now_nanos);

  /// Whether the step to the newest sample was larger than the stream's usual one: samples were
  /// lost.
  bool last_step_was_gap() const { return last_step_was_gap_; }

  /// The next counter is a fresh start, whatever it is.
  void Forget();

 private:
  bool IsRestart(std::uint32_t counter, std::uint32_t behind, std::int64_t now_nanos);
  void LearnStep(std::uint32_t step);
  std::uint32_t UsualStep() const;

  std::optional<std::uint32_t> newest_;
  std::int64_t newest_heard_nanos_ = 0;
  std::uint32_t late_counter_ = 0;  // highest of the run of late ones
  int late_run_ = 0;

  std::array<std::uint32_t, 16> steps_{};  // ring of the latest
  std::size_t step_count_ = 0;             // in all
  bool last_step_was_gap_ = false;
};

}  // namespace kinescope::mvn
