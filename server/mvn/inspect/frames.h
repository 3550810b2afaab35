/// Analyses the frames of one character of a sender by their headers: which exist, which are
/// missing, when they arrived. A frame is all messages with one sample counter, whatever their
/// types, and whether or not they make a sample. Memory does not grow; one thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "core/duration_histogram.h"
#include "server/mvn/arrival.h"
#include "server/mvn/clock_fit.h"
#include "server/mvn/stream_line.h"

namespace kinescope::mvn {

class FrameTrack {
 public:
  static constexpr std::size_t kTypes = 100;

  enum class Confirmation {
    kUnconfirmed,  // from a network: a header that contradicts earlier ones is corrupt, or a
                   // restart
    kConfirmed,    // of samples: already checked by their source
  };
  explicit FrameTrack(Confirmation confirmation = Confirmation::kUnconfirmed)
      : confirmation_(confirmation) {}

  /// Adds a datagram of a message type that belongs to a sample (not 12 and 13).
  void Add(int type, std::uint32_t counter, std::uint32_t time_code_millis, const Arrival& arrival);

  std::uint64_t frames() const { return frames_; }
  std::uint64_t frames_with(int type) const { return with_type_[static_cast<std::size_t>(type)]; }
  std::optional<std::uint32_t> first_counter() const { return first_counter_; }
  std::optional<std::uint32_t> last_counter() const { return last_counter_; }
  std::uint64_t restarts() const { return restarts_; }
  /// Usual step of the counter from frame to frame; a fraction if two steps alternate (240 Hz sent
  /// at 100 Hz: 2.4). 1 if unknown.
  double usual_step() const;
  /// Smallest and largest step; 0 without a step.
  std::uint32_t smallest_step() const { return smallest_step_; }
  std::uint32_t largest_step() const { return largest_step_; }
  /// Number of frames that are missing according to the counters. nullopt if the counter sometimes
  /// grows by less than its usual step: then no step shows which frames were expected.
  std::optional<std::uint64_t> lost() const;
  /// Frames per second: as received, and as the suit acquired them according to counter and time
  /// code. 0: unknown.
  double arrival_rate_hz() const;
  double capture_rate_hz() const;
  /// Delay of the frames relative to the fastest ones of the last seconds (clock_fit.h).
  const DurationHistogram& delays() const { return delays_; }
  std::int64_t longest_silence_nanos() const { return longest_silence_; }
  std::int64_t longest_silence_began_nanos() const {
    return longest_silence_began_;
  }  // monotonic clock

 private:
  static constexpr std::size_t kRemembered = 256;  // one second at 240 Hz
  static constexpr std::size_t kSteps = 64;

  struct Frame {
    bool is_used = false;
    std::uint32_t counter = 0;
    std::bitset<kTypes> types;
  };
  struct Doubt {  // a frame that is either the first after a restart or corrupt
    int type = 0;
    std::uint32_t counter = 0;
    std::uint32_t millis = 0;
    Arrival arrival;
    int others_since = 0;
  };

  bool BelongsHere(std::uint32_t counter, std::uint32_t millis) const;
  /// True if the current run begins with the doubtful frame.
  bool ConfirmsRestart(int type, std::uint32_t counter, std::uint32_t millis,
                       const Arrival& arrival);
  void Take(int type, std::uint32_t counter, std::uint32_t millis, const Arrival& arrival);
  void BeginFrame(std::uint32_t counter, std::uint32_t millis, const Arrival& arrival);
  void CloseRun();

  Confirmation confirmation_;
  std::array<Frame, kRemembered> remembered_{};
  std::optional<Doubt> doubt_;
  std::uint64_t frames_ = 0;
  std::array<std::uint64_t, kTypes> with_type_{};
  std::optional<std::uint32_t> first_counter_;
  std::optional<std::uint32_t> last_counter_;
  std::uint64_t restarts_ = 0;
  std::array<std::uint64_t, kSteps> steps_{};
  std::uint32_t smallest_step_ = 0;
  std::uint32_t largest_step_ = 0;

  // The run since the last restart, and the sums of earlier runs.
  std::optional<std::uint32_t> run_first_;
  std::uint32_t run_newest_ = 0;
  std::uint32_t run_first_millis_ = 0;
  std::uint32_t run_newest_millis_ = 0;
  TimeCodeLine line_;
  double closed_counts_ = 0;
  double closed_millis_ = 0;

  ClockFit clock_;
  DurationHistogram delays_;
  std::optional<Arrival> first_arrival_;
  std::int64_t last_arrival_ = 0;  // monotonic
  std::int64_t longest_silence_ = 0;
  std::int64_t longest_silence_began_ = 0;
};

}  // namespace kinescope::mvn
