/// Plays a source that gives samples as fast as it is asked (a file, the built-in subject) at its
/// true rate, as if it came from suits now. Several people may be in it: theirs come in order of
/// time, whatever order they have in the file. One thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <variant>

#include "core/source.h"

namespace kinescope::app {

class PacedSource : public Source, private SampleSink {
 public:
  using Open = std::function<std::unique_ptr<Source>()>;

  /// Plays `source`. At its end `reopen`, where there is one, gives the source of the next round:
  /// counters, time codes and stamps go on from where they were.
  explicit PacedSource(std::unique_ptr<Source> source, Open reopen = nullptr);

  /// Hands on what is due. Returns when something came or `timeout` is over. What the source throws
  /// comes after the samples before it.
  [[nodiscard]] State Poll(std::chrono::milliseconds timeout, SampleSink& sink) override;

  /// Of all rounds; `samples` are those handed on.
  SourceCounters counters() const override;
  std::string description() const override { return source_->description(); }
  bool is_live() const override { return true; }
  double nominal_rate_hz() const override { return source_->nominal_rate_hz(); }

 private:
  // What was read and is not yet due. Samples hold played times where their stamps go.
  using Event = std::variant<Character, BodySample, ObjectsSample>;

  // One person, or cluster of objects, by id.
  struct Track {
    std::uint32_t counter_offset = 0;  // from the file's counters to ours
    std::uint32_t last_counter = 0;    // ours
    std::int64_t last_played = 0;
    std::uint64_t samples = 0;  // of this round
  };

  void OnCharacter(const Character& character) override;
  void OnSample(const BodySample& sample) override;
  void OnObjects(const ObjectsSample& sample) override;

  template <class Sample>
  void Enqueue(Sample sample);
  void EnqueueCharacter(int id, std::int64_t played);
  void ReadAhead(std::int64_t deadline);
  bool HasEnough() const;
  void EndRound();
  void HandOn(Event& event, std::int64_t played, SampleSink& sink);

  std::unique_ptr<Source> source_;
  Open reopen_;
  SourceCounters earlier_;  // of the rounds before this one
  std::uint64_t samples_ = 0;

  // "Played" time is nanoseconds since the first sample of the first round.
  std::multimap<std::int64_t, Event> queue_;  // by played time; equal ones as they were read
  std::map<int, Character> characters_;       // by id, until their next sample tells when
  std::map<int, Track> tracks_;
  bool read_all_ = false;
  std::exception_ptr failure_;  // why reading ended early

  bool is_round_empty_ = true;
  std::int64_t first_stamp_ = 0;   // of this round
  std::int64_t round_offset_ = 0;  // played before this round
  std::int64_t last_played_ = 0;   // of what was read
  bool has_started_ = false;
  std::int64_t start_monotonic_ = 0;
  std::int64_t start_wall_ = 0;
};

}  // namespace kinescope::app
