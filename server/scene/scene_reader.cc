#include "server/scene/scene_reader.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <stdexcept>
#include <utility>

#include "core/scene_interpolation.h"
#include "core/system/check.h"
#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/stop_signal.h"
#include "server/source/open_source.h"
#include "server/source/scheme.h"

namespace kinescope::app {
namespace {

// The built-in subject is as tall as the person is said to be.
SourceSettings SettingsFor(const SceneOptions& options, SourceSettings settings) {
  settings.subject_height_m = options.height_m;
  settings.bag = options.bag;
  return settings;
}

// The URL; told before a graph or a socket is waited for.
const std::string& RecordedUrl(const std::string& url) {
  if (!IsLiveUrl(url)) return url;
  throw UsageError(fmt::format(
      "source '{}': this command cannot read a live stream; record the stream first ({}), or use "
      "demo:lift",
      url, KindOfSource(url) == SourceKind::kGraph ? "rosbag record -a" : "kinescope record"));
}

}  // namespace

void CheckReach(const std::string& option, double secs, const std::string& url) {
  if (!IsSubjectUrl(url) || secs <= kSubjectLatestSecs) return;
  throw UsageError(fmt::format("{}: {} is generated motion; expected at most {} s after its start",
                               option, url, kSubjectLatestSecs));
}

bool IsWithinLength(std::int64_t begin_nanos, std::int64_t stamp_nanos,
                    std::optional<double> length_secs) {
  constexpr double kRounding = 1e-6;  // s
  return !length_secs || Secs(stamp_nanos - begin_nanos) <= *length_secs + kRounding;
}

SceneReader::SceneReader(std::unique_ptr<Source> source, const std::string& url,
                         const SceneOptions& options)
    : url_(url),
      cutoff_hz_(options.loads.motion.recording_cutoff_hz),
      source_(std::move(source)),
      builder_(options, url, source_->nominal_rate_hz(),
               [this](const std::shared_ptr<const SceneState>& state) { ready_.push_back(state); }),
      smoother_(cutoff_hz_, builders_) {
  builders_.to.push_back(&builder_);
  builder_.Start();
  empty_ = std::move(ready_.front());
  ready_.pop_front();
}

SceneReader::SceneReader(const std::string& url, const SceneOptions& options)
    : SceneReader(OpenSource(RecordedUrl(url), SettingsFor(options, {})), url, options) {}

SceneReader SceneReader::OfAnySource(const std::string& url, const SceneOptions& options,
                                     const SourceSettings& settings) {
  return SceneReader(OpenSource(url, SettingsFor(options, settings)), url, options);
}

// What has arrived before the stop is read.
void SceneReader::ReadRest() {
  std::uint64_t before = 0;
  do {
    before = source_->counters().datagrams;
    if (source_->Poll(std::chrono::milliseconds(0), smoother_) == Source::State::kEnded) return;
  } while (source_->counters().datagrams > before);
  source_->Flush(smoother_);
}

void SceneReader::Also(const SceneOptions& options, SceneBuilder::OnState on_state) {
  KINESCOPE_CHECK(options.loads.motion.recording_cutoff_hz == cutoff_hz_);
  others_.push_back(std::make_unique<SceneBuilder>(options, url_, source_->nominal_rate_hz(),
                                                   std::move(on_state)));
  others_.back()->Start();
  builders_.to.push_back(others_.back().get());
}

void SceneReader::FanOut::OnCharacter(const Character& character) {
  for (SmoothSampleSink* const each : to) each->OnCharacter(character);
}

void SceneReader::FanOut::OnSample(const BodySample& sample, const loads::BodyMotion* motion) {
  for (SmoothSampleSink* const each : to) each->OnSample(sample, motion);
}

void SceneReader::FanOut::OnObjects(const ObjectsSample& sample) {
  for (SmoothSampleSink* const each : to) each->OnObjects(sample);
}

void SceneReader::FanOut::OnSurroundings(const RecordedSurroundings& all) {
  for (SmoothSampleSink* const each : to) each->OnSurroundings(all);
}

void SceneReader::FanOut::OnMoment(const SourceMoment& moment) {
  for (SmoothSampleSink* const each : to) each->OnMoment(moment);
}

std::shared_ptr<const SceneState> SceneReader::Next() {
  constexpr std::chrono::milliseconds kBetweenChecks(100);
  while (ready_.empty() && !ended_) {
    const auto state =
        source_->Poll(is_live() ? kBetweenChecks : std::chrono::milliseconds(0), smoother_);
    ended_ = state == Source::State::kEnded;
    if (is_live()) WarnIfNothingComes();
    if (!ended_ && is_live() && StopRequested()) {
      ReadRest();
      ended_ = true;
    }
    if (ended_) smoother_.End();
  }
  if (ready_.empty()) return nullptr;
  is_waiting_ = false;
  auto state = std::move(ready_.front());
  ready_.pop_front();
  return state;
}

void SceneReader::WarnIfNothingComes() {
  constexpr std::int64_t kPatienceSecs = 4;  // a state comes up to two seconds after its sample
  if (!is_waiting_ || !ready_.empty()) return;
  if (MonotonicNanos() < started_nanos_ + kPatienceSecs * kNanosPerSecond) return;
  is_waiting_ = false;
  spdlog::warn("{}: no pose of a person within {} s; check the stream with `kinescope inspect {}`",
               source_->description(), kPatienceSecs, url_);
}

std::shared_ptr<const SceneState> SceneReader::Stale() {
  builder_.MarkStale();
  auto state = std::move(ready_.back());
  ready_.pop_back();
  return state;
}

SceneTimeline::SceneTimeline(SceneReader& reader)
    : SceneTimeline([&reader] {
        if (StopRequested()) throw std::runtime_error("interrupted while reading " + reader.url());
        return reader.Next();
      }) {}

SceneTimeline::SceneTimeline(ReadNext next)
    : next_(std::move(next)), before_(next_()), after_(before_ ? next_() : nullptr) {
  if (before_) start_nanos_ = before_->stamp_nanos;
}

std::optional<SceneState> SceneTimeline::At(double secs) {
  return AtNanos(std::llround(secs * 1e9));
}

double SceneTimeline::NewestSecs() const {
  const auto& newest = after_ ? after_ : before_;
  return newest ? Secs(newest->stamp_nanos - start_nanos_) : 0;
}

std::optional<SceneState> SceneTimeline::AtNanos(std::int64_t nanos) {
  const std::int64_t stamp = start_nanos_ + nanos;
  while (after_ && after_->stamp_nanos < stamp) {
    before_ = std::exchange(after_, next_());
  }
  if (!before_) return std::nullopt;
  // The grid may miss the last sample by the rounding of its stamps, not by more.
  constexpr std::int64_t kRoundingNanos = 1000;
  if (!after_) {
    if (stamp > before_->stamp_nanos + kRoundingNanos) return std::nullopt;
    return *before_;
  }
  return Interpolate(*before_, *after_, stamp);
}

}  // namespace kinescope::app
