/// Plays a source that gives samples as fast as it is asked (a file, the built-in subject) at its
/// true rate, as if it came from a suit now.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/core/source.h"

namespace kinescope::app {

class PacedSource : public Source, private SampleSink {
 public:
  using Open = std::function<std::unique_ptr<Source>()>;

  /// `open` is called once now, and again at the end of each round when `loop` is set.
  PacedSource(Open open, bool loop);

  /// Hands on the samples that are due. Returns when one came or `timeout` is over.
  State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;

  SourceCounters counters() const override { return counters_; }
  std::string description() const override { return source_->description(); }
  bool is_live() const override { return true; }
  double nominal_rate_hz() const override { return source_->nominal_rate_hz(); }

 private:
  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  /// False at the end.
  bool ReadNext(SampleSink& sink);
  std::int64_t DueNanos() const;  // of next_, monotonic clock
  BodySample AsIfNow(const BodySample& sample) const;

  Open open_;
  bool loop_;
  std::unique_ptr<Source> source_;
  SourceCounters counters_;
  SampleSink* characters_to_ = nullptr;  // during ReadNext
  std::optional<BodySample> next_;       // read, not yet due
  std::int64_t start_monotonic_ = 0;
  std::int64_t start_wall_ = 0;
  std::int64_t first_stamp_ = 0;      // of this round
  std::int64_t round_offset_ = 0;     // nanoseconds played in earlier rounds
  std::uint32_t counter_offset_ = 0;  // likewise, samples
  std::int64_t last_stamp_ = 0;       // of the sample given last, its own clock
  std::uint32_t last_counter_ = 0;
  bool has_started_ = false;
  bool at_round_start_ = true;
};

}  // namespace kinescope::app
