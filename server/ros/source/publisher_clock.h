/// Compares the clock of a node, as its stamps and answers show it, with this computer's, and says
/// what to add to its stamps where the two differ. Time is an argument; one thread.
///
/// A stamp alone tells the sum of delay and difference. A round trip (node_time.h) tells them
/// apart, up to half its duration and what the clocks drift after it; stamps of a node that does
/// not tell its time are not shifted. All times of this computer are by its wall clock.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/node_clock.h"

namespace kinescope::ros_bridge {

/// A question for the time and its answer, ns.
struct RoundTrip {
  std::int64_t sent = 0, received = 0;  // by one clock of this computer
  std::int64_t theirs = 0;              // their wall clock
};

class PublisherClock {
 public:
  /// Stamps within this of this computer's time are used as they are, so that what is published
  /// here has the stamps of the frames; after a clock was set, until the next round trip, within
  /// kAcceptedUnasked: a network that delays a message by so much is not taken for a clock.
  static constexpr std::int64_t kAccepted = 200'000'000;
  static constexpr std::int64_t kAcceptedUnasked = 1'000'000'000;
  /// Stamps that go back by more, or come on by kAdvance more than the time that has passed, are of
  /// a clock that was set.
  static constexpr std::int64_t kBack = 100'000'000;
  static constexpr std::int64_t kAdvance = 1'000'000'000;
  /// Stamps that are ahead of the clock that answers by more are not of that clock.
  static constexpr std::int64_t kAheadOfAnswer = 1'000'000'000;

  /// The newest stamp of a message, by the node's clock, and its arrival.
  void OnStamp(std::int64_t stamp, std::int64_t arrival);
  void OnRoundTrip(const RoundTrip& trip);
  /// This computer's wall clock was set. The next stamps may go back with it.
  void OnOwnClockSet(std::int64_t by);

  /// To be added to the stamps of the message of the last OnStamp. Stamps do not go back by it, nor
  /// with a clock that was set back by seconds.
  std::int64_t shift() const { return shift_ + excess_; }
  std::int64_t heard() const { return heard_; }  // arrival of the newest message
  NodeClock Report(std::string node, std::int64_t now) const;

 private:
  static constexpr std::int64_t kWindow = 5'000'000'000;

  struct Lags {
    std::optional<std::int64_t> least, most;
    void Add(std::int64_t lag);
    void Add(const Lags& lags);
  };
  Lags Recent() const;
  /// How much the stamps are behind this computer's time, and what difference is accepted.
  struct Behind {
    std::int64_t nanos = 0, accepted = 0;
  };
  Behind FindBehind() const;
  void Decide(std::int64_t stamp, bool was_set);

  std::optional<std::int64_t> newest_;  // stamp
  std::int64_t newest_shifted_ = 0;
  std::int64_t heard_ = 0;
  Lags before_, now_;  // of the last full window, and of this one
  std::int64_t window_begin_ = 0;
  std::optional<RoundTrip> best_;
  bool tells_time_ = false;  // there was a round trip
  std::int64_t shift_ = 0;
  std::int64_t excess_ = 0;  // ≥ 0: keeps time from going back after the shift has become smaller
};

}  // namespace kinescope::ros_bridge
