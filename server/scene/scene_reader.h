/// Reads a file or the built-in subject as scene states, one after the other, without pacing. Each
/// object is used by one thread at a time.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/source.h"
#include "core/system/clocks.h"
#include "server/scene/sample_smoother.h"
#include "server/scene/scene_builder.h"
#include "server/source/open_source.h"

namespace kinescope::app {

/// The latest time of a recording that an option may set, s after its first sample: ten days,
/// longer than any recording and far below the range of nanoseconds in 64 bits.
inline constexpr double kLatestSecs = 864'000;
/// The latest sample: that of the latest time at the highest sample rate.
inline constexpr double kLatestSample = kLatestSecs * 1000;

/// To be called before a time that a user has set is looked for: the built-in subject has no end,
/// and would be generated until then. `option`: "--time=800000".
/// @throws UsageError with the option and the latest time of the built-in subject.
void CheckReach(const std::string& option, double secs, const std::string& url);

/// Whether a sample belongs to the first `length_secs` of a motion that begins at `begin_nanos`,
/// the one at the end included; rounded stamps do not decide. nullopt: all of it.
bool IsWithinLength(std::int64_t begin_nanos, std::int64_t stamp_nanos,
                    std::optional<double> length_secs);

/// The motion of recordings is filtered without lag, up to two seconds ahead of the state.
class SceneReader {
 public:
  /// @throws SourceError; UsageError for a live source, which has neither an end nor sample numbers
  /// from its beginning.
  SceneReader(const std::string& url, const SceneOptions& options);
  /// Of any source: a live one ends when the program is asked to stop (core/system/stop_signal.h).
  /// Its states come up to two seconds late. @throws SourceError
  static SceneReader OfAnySource(const std::string& url, const SceneOptions& options,
                                 const SourceSettings& settings);

  /// Computes the states under other `options`, too, from the same samples, which are read once.
  /// `on_state` receives them during Next(), some before Next() returns the state of their sample.
  /// @pre Next() was not called; recordings are filtered at one cut-off
  void Also(const SceneOptions& options, SceneBuilder::OnState on_state);

  SceneReader(const SceneReader&) = delete;
  SceneReader& operator=(const SceneReader&) = delete;

  /// The state of the next sample; null at the end.
  std::shared_ptr<const SceneState> Next();

  /// The state before the first sample: "no data".
  std::shared_ptr<const SceneState> Empty() const { return empty_; }
  /// The newest state, as it looks after the stream has stopped.
  std::shared_ptr<const SceneState> Stale();

  double rate_hz() const { return source_->nominal_rate_hz(); }
  bool is_live() const { return source_->is_live(); }
  std::string description() const { return source_->description(); }  // "udp://0.0.0.0:9763"
  const std::string& url() const { return url_; }

 private:
  class FanOut : public SmoothSampleSink {
   public:
    void OnCharacter(const Character& character) override;
    void OnSample(const BodySample& sample, const loads::BodyMotion* motion) override;
    void OnObjects(const ObjectsSample& sample) override;
    void OnSurroundings(const RecordedSurroundings& all) override;
    void OnMoment(const SourceMoment& moment) override;
    std::vector<SmoothSampleSink*> to;
  };

  SceneReader(std::unique_ptr<Source> source, const std::string& url, const SceneOptions& options);
  void ReadRest();
  void WarnIfNothingComes();

  const std::string url_;
  const double cutoff_hz_;
  std::unique_ptr<Source> source_;
  std::deque<std::shared_ptr<const SceneState>> ready_;
  std::shared_ptr<const SceneState> empty_;
  SceneBuilder builder_;
  std::vector<std::unique_ptr<SceneBuilder>> others_;
  FanOut builders_;  // builder_ and others_
  SampleSmoother smoother_;
  bool ended_ = false;
  const std::int64_t started_nanos_ = MonotonicNanos();
  bool is_waiting_ = true;  // for the first state, and without a warning
};

/// Computes the scene at ascending times: reads states as needed and interpolates between them. One
/// thread.
class SceneTimeline {
 public:
  using ReadNext = std::function<std::shared_ptr<const SceneState>()>;

  /// Ctrl-C interrupts the reading. @throws std::runtime_error then, with the source.
  explicit SceneTimeline(SceneReader& reader);
  /// `next` returns the states, one after the other; null at the end.
  explicit SceneTimeline(ReadNext next);

  /// The scene `secs` after the first sample; nullopt after the last one.
  /// @pre 0 <= secs <= kLatestSecs, not before the time of the last call.
  std::optional<SceneState> At(double secs);
  std::optional<SceneState> AtNanos(std::int64_t nanos);
  /// The newest state that was read, s after the first sample: the end of the source, after
  /// nullopt.
  double NewestSecs() const;

 private:
  ReadNext next_;
  std::shared_ptr<const SceneState> before_, after_;
  std::int64_t start_nanos_ = 0;
};

}  // namespace kinescope::app
