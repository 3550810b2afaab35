/// The frames of one sender's character, told by their headers: which there were, which are
/// missing, how they arrived. A frame is what has one sample counter, whatever types it comes in
/// and whether a sample can be made of it. Memory does not grow; one thread.
#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>

#include "server/mvn/arrival.h"
#include "server/mvn/clock_fit.h"
#include "server/mvn/inspect/histogram.h"
#include "server/mvn/stream_line.h"

namespace kinescope::mvn {

class FrameTrack {
 public:
  static constexpr std::size_t kTypes = 100;

  enum class Trust {
    kNone,   // from a network: a header that contradicts those before is damaged, or a restart
    kWhole,  // of samples: their source has seen to that
  };
  explicit FrameTrack(Trust trust = Trust::kNone) : trust_(trust) {}

  /// A datagram of a message type that belongs to a sample (not 12 and 13).
  void Add(int type, std::uint32_t counter, std::uint32_t time_code_millis, const Arrival& arrival);

  std::uint64_t frames() const { return frames_; }
  std::uint64_t frames_with(int type) const { return with_type_[static_cast<std::size_t>(type)]; }
  std::optional<std::uint32_t> first_counter() const { return first_counter_; }
  std::optional<std::uint32_t> last_counter() const { return last_counter_; }
  std::uint64_t restarts() const { return restarts_; }
  /// By how much the counter grows from frame to frame; a fraction where two steps alternate (240
  /// Hz sent at 100 Hz: 2.4). 1 where nothing tells.
  double usual_step() const;
  /// Smallest and largest step; 0 without any.
  std::uint32_t smallest_step() const { return smallest_step_; }
  std::uint32_t largest_step() const { return largest_step_; }
  /// Frames that the counters say there must have been, and that never came. Nullopt where the
  /// counter grows by less than its usual step, too: then no step says what should have come.
  std::optional<std::uint64_t> lost() const;
  /// Frames a second: as they came; and as counter and time code say the suit captures. 0: unknown.
  double arrival_rate_hz() const;
  double capture_rate_hz() const;
  /// How much later frames came than the fastest ones of the last seconds (clock_fit.h).
  const DurationHistogram& delays() const { return delays_; }
  std::int64_t longest_silence_nanos() const { return longest_silence_; }
  std::int64_t longest_silence_began_nanos() const { return longest_silence_began_; }  // monotonic

 private:
  static constexpr std::size_t kRemembered = 256;  // one second at 240 Hz
  static constexpr std::size_t kSteps = 64;

  struct Frame {
    bool is_used = false;
    std::uint32_t counter = 0;
    std::bitset<kTypes> types;
  };
  struct Doubt {  // a frame that may be the first after a restart, or damaged
    int type = 0;
    std::uint32_t counter = 0;
    std::uint32_t millis = 0;
    Arrival arrival;
    int others_since = 0;
  };

  bool BelongsHere(std::uint32_t counter, std::uint32_t millis) const;
  /// True when the run now begins with the frame of the doubt.
  bool ConfirmsRestart(int type, std::uint32_t counter, std::uint32_t millis,
                       const Arrival& arrival);
  void Take(int type, std::uint32_t counter, std::uint32_t millis, const Arrival& arrival);
  void BeginFrame(std::uint32_t counter, std::uint32_t millis, const Arrival& arrival);
  void CloseRun();

  Trust trust_;
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

  // The run since the last restart, and the sum of those before.
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
