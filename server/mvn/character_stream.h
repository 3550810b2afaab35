/// The messages of one character from one sender, joined to samples. See assembler.h for the rules.
/// One thread.
#pragma once

#include <cstdint>
#include <optional>

#include "server/core/source.h"
#include "server/mvn/arrival.h"
#include "server/mvn/clock_fit.h"
#include "server/mvn/counter_tracker.h"
#include "server/mvn/pending_sample.h"
#include "server/mvn/scale_group.h"
#include "server/mvn/tally.h"

namespace kinescope::mvn {

class CharacterStream {
 public:
  /// `id` is what samples and the character carry; `tally` outlives this.
  CharacterStream(int id, Tally& tally) : tally_(&tally) { character_.id = id; }

  int id() const { return character_.id; }
  std::int64_t last_heard_nanos() const { return last_heard_nanos_; }

  /// Any message but NotNeeded; ends in a sample, a character or the tally.
  void Add(const Message& message, const Arrival& arrival, SampleSink& sink);

  /// Gives on what has waited long enough at `now_nanos`.
  void Expire(std::int64_t now_nanos, SampleSink& sink);
  /// When Expire() has something to do; nullopt: nothing waits.
  std::optional<std::int64_t> deadline_nanos() const;

  /// The sender itself was started anew: counters and clock begin again, the person stays.
  void SenderRestarted(SampleSink& sink);

 private:
  void AddToSample(const Message& message, const Arrival& arrival, SampleSink& sink);
  void AddToClosedSample(const Message& message);
  void AddMetaData(const MetaDataMessage& body, SampleSink& sink);
  void AddScale(const Message& message, std::int64_t now_nanos, SampleSink& sink);
  void TakeSkeleton(std::int64_t now_nanos, SampleSink& sink);
  void Begin(const Message& message, const Arrival& arrival);
  void Finish(SampleSink& sink);
  void LearnTypes(SampleTypes begun);
  bool IsComplete() const;
  void Announce(SampleSink& sink);
  std::int64_t PatienceNanos() const;

  Tally* tally_;
  Character character_;
  bool announced_ = false;
  ScaleGroup scale_;
  std::int64_t last_heard_nanos_ = 0;

  CounterTracker counters_;
  ClockFit clock_;
  PendingSample pending_;
  bool open_ = false;  // pending_ is not given on yet

  SampleTypes expected_;                        // what this stream sends with every sample
  std::array<int, kSampleTypeCount> missed_{};  // samples in a row without it
  int finished_ = 0;                            // samples, as long as that matters
  std::optional<double> period_nanos_;          // running mean
  std::optional<std::int64_t> last_begin_nanos_;
};

}  // namespace kinescope::mvn
