/// How a stream is now and how it was: losses, jitter, gaps and rejected datagrams of the last 10 s
/// and in all, with when each was last seen, so that a problem that is over is history. Made of
/// the counters of a source. Time is an argument; one thread.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/source.h"

namespace kinescope::app {

struct StreamHealth {
  static constexpr std::int64_t kRecentNanos = 10'000'000'000;

  struct Events {
    std::uint64_t count = 0;      // in all
    std::uint64_t recent = 0;     // in the last 10 s
    std::int64_t last_nanos = 0;  // monotonic clock; 0: never
  };
  std::uint64_t samples = 0;  // delivered, in all
  std::uint64_t lost = 0;     // in all
  /// Share of the samples that are lost or incomplete: of the last 10 s, and of all. nullopt: none
  /// came.
  std::optional<double> recent_loss, loss;
  std::optional<std::int64_t> jitter;  // ns: 95 % of the samples of the last 10 s came within it,
                                       // after the fastest ones; nullopt: not known
  Events gaps;
  Events incomplete;                       // samples delivered without a part of them
  Events clock_steps;                      // times that the wall clock of this machine was set
  std::map<std::string, Events> rejected;  // by reason
  std::vector<NodeClock> clocks;           // of the nodes whose people are read
};

class StreamHealthMeter {
 public:
  /// Call it a few times a second, with counters that only grow. Losses that end a silence count at
  /// the time of the silence: after an outage, the stream soon loses nothing any more.
  void OnCounters(const SourceCounters& counters, std::int64_t now_nanos);

  const StreamHealth& health() const { return health_; }

 private:
  // From one call to the next.
  struct Slice {
    std::int64_t end_nanos = 0;
    std::uint64_t samples = 0;
    double lost = 0;
    std::uint64_t gaps = 0;
    std::uint64_t incomplete = 0;
    std::uint64_t clock_steps = 0;
    std::map<std::string, std::uint64_t> rejected;
    DurationHistogram delays;  // all so far, at its end
  };
  void SpreadLosses();
  void SumUp();

  StreamHealth health_;
  std::deque<Slice> slices_;       // of the last 10 s
  DurationHistogram delays_then_;  // before the first of them
  std::uint64_t silent_ = 0;       // slices without a sample, up to now
};

/// The health as one JSON object (docs/http.md, "stream").
[[nodiscard]] std::string StreamHealthJson(const StreamHealth& health);

}  // namespace kinescope::app
