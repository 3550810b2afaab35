#include "server/source/paced_source.h"

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <thread>
#include <utility>

#include "core/system/errors.h"

namespace kinescope::app {
namespace {

// People in one capture are out of order by what the network and joining delay one of them.
constexpr std::int64_t kReadAheadNanos = 100 * kNanosPerMilli;
constexpr std::size_t kMaxQueued = 2048;  // some 20 MB

void AddUp(SourceCounters& sum, const SourceCounters& more) {
  sum.datagrams += more.datagrams;
  sum.bytes += more.bytes;
  sum.samples += more.samples;
  sum.incomplete += more.incomplete;
  sum.duplicates += more.duplicates;
  sum.late += more.late;
  sum.counter_gaps += more.counter_gaps;
  sum.lost += more.lost;
  sum.delays.AddAll(more.delays);
  sum.restarts += more.restarts;
  sum.outliers += more.outliers;
  for (const auto& [type, count] : more.types) sum.types[type] += count;
  for (const auto& [reason, count] : more.ignored) sum.ignored[reason] += count;
  for (const auto& [reason, count] : more.rejected) sum.rejected[reason] += count;
  for (const auto& [name, count] : more.transport) sum.transport[name] += count;
}

SourceError EndsBefore(const std::string& source, std::int64_t end, std::int64_t wanted) {
  std::ostringstream why;
  why << source << ": ends " << std::fixed << std::setprecision(3) << Secs(end)
      << " s after its first sample, before " << Secs(wanted) << " s; choose an earlier time";
  return SourceError(why.str());
}

}  // namespace

PacedSource::PacedSource(std::unique_ptr<Source> source, Open reopen, std::int64_t start_at)
    : source_(std::move(source)), reopen_(std::move(reopen)), start_at_(start_at) {}

std::unique_ptr<PacedSource> PacedSource::UpTo(std::int64_t stop_at,
                                               std::unique_ptr<Source> source) {
  auto paced = std::make_unique<PacedSource>(std::move(source));
  paced->stop_at_ = stop_at;
  return paced;
}

void PacedSource::OnCharacter(const Character& character) {
  characters_.insert_or_assign(character.id, character);
}

void PacedSource::OnSample(const BodySample& sample) { Enqueue(sample); }

void PacedSource::OnObjects(const ObjectsSample& sample) { Enqueue(sample); }

void PacedSource::EnqueueCharacter(int id, std::int64_t played) {
  const auto found = characters_.find(id);
  if (found == characters_.end()) return;
  queue_.emplace(played, std::move(found->second));
  characters_.erase(found);
}

// The track with the played time of its sample at `stamp_nanos`.
PacedSource::Track& PacedSource::PlayedOf(int id, std::int64_t stamp_nanos) {
  if (std::exchange(is_round_empty_, false)) first_stamp_ = stamp_nanos;
  const auto [at, is_new] = tracks_.try_emplace(id);
  Track& track = at->second;
  ++track.samples;
  const std::int64_t played = round_offset_ + stamp_nanos - first_stamp_;
  // A file may say anything, but a person's samples stay in their order.
  track.last_played = is_new ? played : std::max(played, track.last_played);
  last_played_ = std::max(last_played_, track.last_played);
  return track;
}

template <class Stamped>
void PacedSource::EnqueueAt(std::int64_t played, Stamped event) {
  if (surroundings_) queue_.emplace(played, *std::exchange(surroundings_, std::nullopt));
  event.stamp_nanos = played;
  queue_.emplace(played, std::move(event));
}

template <class Sample>
void PacedSource::Enqueue(Sample sample) {
  Track& track = PlayedOf(sample.character, sample.stamp_nanos);
  // What is beside it stays, and comes with a later sample.
  if (track.last_played < start_at_) return;
  sample.counter = track.counter.Add(sample.counter);
  sample.time_code_millis += round_offset_ / kNanosPerMilli;
  EnqueueCharacter(sample.character, track.last_played);
  EnqueueAt(track.last_played, std::move(sample));
}

void PacedSource::OnMoment(const SourceMoment& moment) {
  const Track& track = PlayedOf(kNobody, moment.stamp_nanos);
  if (track.last_played >= start_at_) EnqueueAt(track.last_played, moment);
}

bool PacedSource::HasEnough() const {
  return read_all_ || queue_.size() >= kMaxQueued ||
         (!queue_.empty() && last_played_ - queue_.begin()->first >= kReadAheadNanos);
}

void PacedSource::ReadAhead(std::int64_t deadline) {
  try {
    while (!HasEnough()) {
      if (source_->Poll(std::chrono::milliseconds(0), *this) == State::kEnded) EndRound();
      if (MonotonicNanos() > deadline) return;  // a capture of much else
    }
  } catch (const SourceError&) {
    failure_ = std::current_exception();
    read_all_ = true;
  }
}

void PacedSource::EndRound() {
  if (rounds_ == 0) CheckStarted();
  while (!characters_.empty()) EnqueueCharacter(characters_.begin()->first, last_played_);
  if (reopen_ == nullptr || is_round_empty_) {  // an empty round would be followed by another
    read_all_ = true;
    return;
  }
  const auto busiest = std::max_element(
      tracks_.begin(), tracks_.end(),
      [](const auto& a, const auto& b) { return a.second.samples < b.second.samples; });
  const auto steps = static_cast<std::int64_t>(busiest->second.samples) - 1;
  std::int64_t period = steps > 0 ? (last_played_ - round_offset_) / steps : 0;
  const double rate = source_->nominal_rate_hz();
  if (rate > 0) period = static_cast<std::int64_t>(1e9 / rate);
  round_offset_ = last_played_ + period;
  ++rounds_;
  is_round_empty_ = true;
  for (auto& [id, track] : tracks_) {
    track.samples = 0;
    track.counter.BeginRound();
  }
  AddUp(earlier_, source_->counters());
  source_ = reopen_();
}

void PacedSource::HandOn(Event& event, std::int64_t played, SampleSink& sink) {
  if (const auto* character = std::get_if<Character>(&event)) return sink.OnCharacter(*character);
  if (const auto* surroundings = std::get_if<RecordedSurroundings>(&event)) {
    return sink.OnSurroundings(*surroundings);
  }
  const auto as_if_now = [&](auto& sample) {
    sample.stamp_nanos = start_wall_ + played;
    sample.arrival_nanos = now_nanos();
  };
  if (auto* sample = std::get_if<BodySample>(&event)) {
    as_if_now(*sample);
    ++samples_;
    return sink.OnSample(*sample);
  }
  if (auto* moment = std::get_if<SourceMoment>(&event)) {
    as_if_now(*moment);
    return sink.OnMoment(*moment);
  }
  auto& objects = std::get<ObjectsSample>(event);
  as_if_now(objects);
  sink.OnObjects(objects);
}

// All of this moment: several people, or a character and its sample.
void PacedSource::HandOnNext(SampleSink& sink) {
  const std::int64_t moment = queue_.begin()->first;
  if (stop_at_) stopped_clock_ = start_monotonic_ + moment;
  while (!queue_.empty() && queue_.begin()->first == moment) {
    auto next = queue_.extract(queue_.begin());
    HandOn(next.mapped(), moment, sink);
  }
}

void PacedSource::Begin() {
  if (std::exchange(has_started_, true)) return;
  const std::int64_t first = queue_.begin()->first;
  start_monotonic_ = now_nanos() - first;
  // Stamps of 0 are those of no sample.
  start_wall_ = (stop_at_ ? std::max(first_stamp_, kNanosPerSecond) : WallNanos()) - first;
}

Source::State PacedSource::Poll(std::chrono::milliseconds timeout, SampleSink& sink) {
  if (has_stopped_) return State::kEnded;
  const std::int64_t deadline = MonotonicNanos() + timeout.count() * kNanosPerMilli;
  ReadAhead(deadline);
  if (stop_at_) return PollAtOnce(sink);
  if (queue_.empty()) {
    if (failure_ != nullptr) std::rethrow_exception(failure_);
    return read_all_ ? State::kEnded : State::kMore;
  }
  Begin();
  const std::int64_t due = start_monotonic_ + queue_.begin()->first;
  // A file's samples are due at known times; there is no event to wait for but the clock.
  const std::int64_t wait = std::min(due, deadline) - MonotonicNanos();
  if (wait > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(wait));
  if (due > deadline) return State::kMore;
  HandOnNext(sink);
  return State::kMore;
}

Source::State PacedSource::PollAtOnce(SampleSink& sink) {
  const std::int64_t end = kStoppedOriginNanos + *stop_at_;
  if (!HasEnough()) return State::kMore;  // another person may have an earlier sample
  if (queue_.empty()) {
    if (failure_ != nullptr) std::rethrow_exception(failure_);
    CheckReached();
  } else {
    Begin();
    if (start_monotonic_ + queue_.begin()->first <= end) {
      HandOnNext(sink);
      return State::kMore;
    }
  }
  stopped_clock_ = end;
  has_stopped_ = true;
  queue_.clear();
  return State::kEnded;
}

void PacedSource::CheckReached() const {
  // The last sample may miss the moment by the rounding of its stamp, not by more.
  constexpr std::int64_t kRoundingNanos = 1000;
  const std::int64_t played = has_started_ ? stopped_clock_ - kStoppedOriginNanos : -1;
  if (*stop_at_ <= played + kRoundingNanos) return;
  if (played < 0) throw SourceError(description() + ": has no sample");
  throw EndsBefore(description(), played, *stop_at_);
}

// At the end of the first round.
void PacedSource::CheckStarted() const {
  if (is_round_empty_ || last_played_ >= start_at_) return;
  throw EndsBefore(description(), last_played_, start_at_);
}

std::int64_t PacedSource::now_nanos() const { return stop_at_ ? stopped_clock_ : MonotonicNanos(); }

std::optional<Playback> PacedSource::playback() const {
  if (!has_started_) return std::nullopt;
  Playback playback;
  playback.start_nanos = start_wall_;
  if (rounds_ > 0) playback.round_nanos = round_offset_ / rounds_;
  return playback;
}

SourceCounters PacedSource::counters() const {
  SourceCounters sum = earlier_;
  const SourceCounters now = source_->counters();
  AddUp(sum, now);
  sum.problems = now.problems;
  sum.samples = samples_;
  if (!has_started_ && last_played_ < start_at_) sum.passed_nanos = last_played_;
  return sum;
}

}  // namespace kinescope::app
