/// Plays a source without pacing (a file, the built-in subject) at its true rate, as if suits sent
/// it now; or up to a moment at once, as if they had sent it before. Samples of several people are
/// delivered in order of time, whatever their order in the file. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "core/source.h"
#include "core/system/clocks.h"
#include "server/source/counter_splice.h"

namespace kinescope::app {

/// Moment of the first sample of a source that stops at a moment, monotonic clock: always the same,
/// so that all moments are the same in each run.
inline constexpr std::int64_t kStoppedOriginNanos = 3600 * kNanosPerSecond;

class PacedSource : public Source, private SampleSink {
 public:
  using Open = std::function<std::unique_ptr<Source>()>;

  /// Plays `source`. At its end, `reopen` (if not null) returns the source of the next round:
  /// counters, time codes and stamps continue.
  /// @param start_at  ns after the first sample, in the first round: the samples before it are read
  ///   at once and not delivered
  explicit PacedSource(std::unique_ptr<Source> source, Open reopen = nullptr,
                       std::int64_t start_at = 0);

  /// Delivers the samples up to `stop_at` (ns after the first one) at once, and then no more, with
  /// the source's own stamps. Its time stands still there.
  static std::unique_ptr<PacedSource> UpTo(std::int64_t stop_at, std::unique_ptr<Source> source);

  /// Delivers the samples that are due. Returns after a delivery or after `timeout`. Exceptions of
  /// the source are thrown after the samples before them.
  /// @throws SourceError if the source ends before the moment at which it is to stop
  [[nodiscard]] State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;

  /// Over all rounds; `samples` are those delivered.
  SourceCounters counters() const override;
  std::string description() const override { return source_->description(); }
  bool is_live() const override { return true; }
  double nominal_rate_hz() const override { return source_->nominal_rate_hz(); }
  std::optional<Playback> playback() const override;
  std::int64_t now_nanos() const override;

 private:
  // Read but not due yet. In queued samples the stamp is the played time.
  using Event =
      std::variant<Character, BodySample, ObjectsSample, RecordedSurroundings, SourceMoment>;

  // One person, or group of objects, by id; the moments without a person, as kNobody.
  struct Track {
    CounterSplice counter;
    std::int64_t last_played = 0;
    std::uint64_t samples = 0;  // of this round
  };

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;
  void OnSurroundings(const RecordedSurroundings& all) override { surroundings_ = all; }
  void OnMoment(const SourceMoment& moment) override;

  static constexpr int kNobody = -1;

  Track& PlayedOf(int id, std::int64_t stamp_nanos);
  template <class Stamped>
  void EnqueueAt(std::int64_t played, Stamped event);
  template <class Sample>
  void Enqueue(Sample sample);
  void EnqueueCharacter(int id, std::int64_t played);
  void ReadAhead(std::int64_t deadline);
  bool HasEnough() const;
  void EndRound();
  void HandOn(Event& event, std::int64_t played, SampleSink& sink);
  void HandOnNext(SampleSink& sink);
  void Begin();
  State PollAtOnce(SampleSink& sink);
  void CheckReached() const;
  void CheckStarted() const;

  std::unique_ptr<Source> source_;
  Open reopen_;
  const std::int64_t start_at_;
  SourceCounters earlier_;  // of earlier rounds
  std::uint64_t samples_ = 0;
  std::optional<std::int64_t> stop_at_;  // after the first sample; nullopt: at the true rate
  std::int64_t stopped_clock_ = kStoppedOriginNanos;  // its time; with stop_at_
  bool has_stopped_ = false;

  // "Played" time is ns since the first sample of the first round.
  std::multimap<std::int64_t, Event> queue_;  // by played time; entries with equal times in the
                                              // order of reading
  std::map<int, Character> characters_;       // by id, until their next sample gives the time
  std::optional<RecordedSurroundings> surroundings_;  // until the next sample gives the time
  std::map<int, Track> tracks_;
  bool read_all_ = false;
  std::exception_ptr failure_;  // why reading ended early

  bool is_round_empty_ = true;
  std::int64_t first_stamp_ = 0;   // of this round
  std::int64_t round_offset_ = 0;  // played time before this round
  std::int64_t rounds_ = 0;        // before this one
  std::int64_t last_played_ = 0;   // of the newest sample read
  bool has_started_ = false;
  std::int64_t start_monotonic_ = 0;
  std::int64_t start_wall_ = 0;
};

}  // namespace kinescope::app
