#include "server/mvn/character_stream.h"

#include <algorithm>
#include <utility>
#include <variant>

namespace kinescope::mvn {
namespace {

constexpr double kPeriodGain = 1.0 / 16;
constexpr double kLongestInterval = 0.5e9;  // a pause is not a period
constexpr double kPatienceInPeriods = 1.5;
constexpr double kMinPatience = 5e6;
constexpr double kMaxPatience = 100e6;
constexpr double kFirstPatience = 50e6;  // until the period is known
constexpr std::int64_t kPatienceOfFiles = 1'000'000'000;

constexpr std::int32_t kMaxFramesReordered = 120;  // half a second at 240 Hz
constexpr int kPlacesReordered = 3;
constexpr std::int64_t kSilenceNanos = 250'000'000;  // afterwards a lower counter is a restart
constexpr std::int64_t kDoubtNanos = 250'000'000;
constexpr std::uint32_t kStepsToBelieve = 8;
constexpr std::int32_t kMillisToBelieve = 1000;
constexpr int kRunOfRestart = 8;

}  // namespace

void CharacterStream::Add(const Message& message, std::uint32_t digest, const Arrival& arrival,
                          SampleSink& sink) {
  last_heard_nanos_ = arrival.monotonic_nanos;
  if (std::exchange(is_heard_, true)) is_confirmed_ = true;
  // Types 12 and 13 have counter and time code 0 in the middle of a stream, so they never affect
  // the samples.
  if (const auto* meta = std::get_if<MetaDataMessage>(&message.body)) {
    AddMetaData(*meta, sink);
  } else if (std::holds_alternative<ScaleMessage>(message.body)) {
    AddScale(message, arrival.monotonic_nanos, sink);
  } else {
    AddToSample(message, digest, arrival, sink);
  }
  if (is_confirmed_) AnnounceOnce(sink);
}

void CharacterStream::AddMetaData(const MetaDataMessage& body, SampleSink& sink) {
  ++tally_->in_characters;
  const bool changed = (body.name && *body.name != character_.name) ||
                       (body.color_rgb && body.color_rgb != character_.color_rgb);
  if (body.name) character_.name = *body.name;
  if (body.color_rgb) character_.color_rgb = body.color_rgb;
  if (changed) Announce(sink);
}

void CharacterStream::AddScale(const Message& message, std::int64_t now_nanos, SampleSink& sink) {
  const auto refused = scale_.Add(message.header, std::get<ScaleMessage>(message.body), now_nanos);
  if (refused) return tally_->Reject(*refused);
  ++tally_->in_characters;
  TakeScale(now_nanos, sink);
}

void CharacterStream::TakeScale(std::int64_t now_nanos, SampleSink& sink) {
  const auto scale = scale_.Take(now_nanos);
  if (!scale) return;
  const bool same = character_.skeleton == scale->skeleton &&
                    character_.landmarks == scale->landmarks &&
                    character_.scaled_segments == scale->scaled_segments;
  if (same) return;
  character_.skeleton = scale->skeleton;
  character_.landmarks = scale->landmarks;
  character_.scaled_segments = scale->scaled_segments;
  Announce(sink);
}

// Delivers the known properties with the first datagram that is certainly not corrupt.
void CharacterStream::Announce(SampleSink& sink) {
  wants_announcement_ = true;
  if (is_confirmed_) AnnounceOnce(sink);
}

void CharacterStream::AnnounceOnce(SampleSink& sink) {
  if (!wants_announcement_) return;
  // A sample alone does not make a character: its message may contain no pose.
  if (character_.name.empty() && !character_.color_rgb && !character_.skeleton &&
      character_.scaled_segments.empty() && !has_given_) {
    return;
  }
  wants_announcement_ = false;
  sink.OnCharacter(character_);
}

void CharacterStream::AddToSample(const Message& message, std::uint32_t digest,
                                  const Arrival& arrival, SampleSink& sink) {
  const Header& header = message.header;
  const SampleType type = *SampleTypeOf(header.type);
  const std::int64_t now = arrival.monotonic_nanos;
  if (doubtful_ && now - doubtful_->arrival.monotonic_nanos > kDoubtNanos) DropDoubtful();
  const Place place = PlaceOf(header, type, digest, now);
  switch (place) {
    case Place::kFits:
      repeated_length_ = 0;
      newest_heard_nanos_ = now;
      // A sender that has started over does not continue the old run, except with datagrams already
      // under way.
      if (doubtful_ && ++doubtful_->fitted_since > kPlacesReordered) DropDoubtful();
      return Accept(message, digest, arrival, sink);
    case Place::kDuplicate:
    case Place::kLate: {
      if (IsRestartByRun(header.sample_counter)) break;
      const bool is_late = place == Place::kLate;
      ++(is_late ? tally_->late : tally_->duplicates);
      if (is_late && header.sample_counter == closed_) {
        // A type that was just switched on arrives after a sample that did not wait for it.
        types_.Expect(type);
      }
      return;
    }
    case Place::kDoubtful: return Doubt(message, digest, arrival, sink);
    case Place::kRestart: break;
  }
  Restart(sink);
  newest_heard_nanos_ = now;
  Accept(message, digest, arrival, sink);
}

CharacterStream::Place CharacterStream::PlaceOf(const Header& header, SampleType type,
                                                std::uint32_t digest, std::int64_t now) const {
  const std::uint32_t counter = header.sample_counter;
  if (!newest_ || Find(counter) != nullptr) return Place::kFits;
  const std::int32_t ahead = Ahead(counter, *newest_);
  if (ahead <= 0 && closed_ && Ahead(counter, *closed_) <= 0) {
    return PlaceBehind(header, type, digest, now);
  }
  switch (line_.Fits(counter, header.time_code_millis)) {
    case TimeCodeLine::Fit::kYes: return Place::kFits;
    case TimeCodeLine::Fit::kNo: break;
    case TimeCodeLine::Fit::kUnknown:
      if (ahead <= PlausibleStep()) return Place::kFits;
      break;
  }
  return ahead < 0 && now - newest_heard_nanos_ > kSilenceNanos ? Place::kRestart
                                                                : Place::kDoubtful;
}

// For a counter that is not later than the last delivered one.
CharacterStream::Place CharacterStream::PlaceBehind(const Header& header, SampleType type,
                                                    std::uint32_t digest, std::int64_t now) const {
  switch (history_.Find(header, type, digest)) {
    case ClosedSamples::Known::kSame: return Place::kDuplicate;
    case ClosedSamples::Known::kMissing: return Place::kLate;
    case ClosedSamples::Known::kDifferent: break;
    case ClosedSamples::Known::kNo: {
      const auto fit = line_.Fits(header.sample_counter, header.time_code_millis);
      const bool near = Ahead(*newest_, header.sample_counter) <= kMaxFramesReordered;
      // Once the run has begun, a datagram before its first sample is not a late one.
      const bool before_the_run = Ahead(header.sample_counter, run_start_) < 0 &&
                                  Ahead(*newest_, run_start_) >= PlausibleStep();
      if (near && !before_the_run && fit != TimeCodeLine::Fit::kNo) return Place::kLate;
      break;
    }
  }
  return now - newest_heard_nanos_ > kSilenceNanos ? Place::kRestart : Place::kDoubtful;
}

// Whether there were enough late or repeated samples in a row, each after the one before and no new
// ones between them, to conclude that the sender plays the same again.
bool CharacterStream::IsRestartByRun(std::uint32_t counter) {
  if (repeated_length_ > 0 && counter == repeated_counter_) return false;  // same sample, next type
  const bool in_order = repeated_length_ > 0 && Ahead(counter, repeated_counter_) > 0;
  repeated_length_ = in_order ? repeated_length_ + 1 : 1;
  repeated_counter_ = counter;
  return repeated_length_ >= kRunOfRestart;
}

void CharacterStream::Accept(const Message& message, std::uint32_t digest, const Arrival& arrival,
                             SampleSink& sink) {
  OpenSample* open = Find(message.header.sample_counter);
  if (open == nullptr) open = &Open(message, arrival, sink);
  switch (open->sample.Add(message, digest, arrival.monotonic_nanos)) {
    case PendingSample::Added::kDuplicate: ++tally_->duplicates; return;
    case PendingSample::Added::kOther: return Doubt(message, digest, arrival, sink);
    case PendingSample::Added::kContradiction: tally_->Reject(Reason::kPartsContradict); return;
    case PendingSample::Added::kYes: break;
  }
  FinishOvertakenBy(open->sample, sink);
  if (types_.AreAllIn(open->sample.whole())) FinishUpTo(open->sample.counter(), sink);
}

// The largest step of the counter that is accepted without other evidence.
std::int32_t CharacterStream::PlausibleStep() const {
  return static_cast<std::int32_t>(kStepsToBelieve * steps_.usual());
}

// Whether `next` may follow `first` in a new run of the sender.
bool CharacterStream::GoesOnFrom(const Header& first, const Header& next) const {
  const std::int32_t steps = Ahead(next.sample_counter, first.sample_counter);
  const std::int32_t millis = Ahead(next.time_code_millis, first.time_code_millis);
  if (steps == 0) return millis == 0;
  return steps > 0 && steps <= PlausibleStep() && millis >= 0 && millis <= kMillisToBelieve;
}

// A datagram that contradicts the stream is accepted if the next doubtful one continues it.
void CharacterStream::Doubt(const Message& message, std::uint32_t digest, const Arrival& arrival,
                            SampleSink& sink) {
  if (doubtful_) {
    if (GoesOnFrom(doubtful_->message.header, message.header)) {
      const Doubtful first = *doubtful_;
      doubtful_.reset();
      Restart(sink);
      newest_heard_nanos_ = arrival.monotonic_nanos;
      Accept(first.message, first.digest, first.arrival, sink);
      return AddToSample(message, digest, arrival, sink);
    }
    DropDoubtful();
  }
  doubtful_ = Doubtful{message, digest, arrival};
}

void CharacterStream::DropDoubtful() {
  if (!doubtful_) return;
  doubtful_.reset();
  ++tally_->outliers;
}

void CharacterStream::Restart(SampleSink& sink) {
  ++tally_->restarts;
  SenderRestarted(sink);
}

void CharacterStream::SenderRestarted(SampleSink& sink) {
  FinishAll(sink);
  DropDoubtful();
  newest_.reset();
  closed_.reset();
  history_.Clear();
  line_.Restart();
  clock_.Restart();
  repeated_length_ = 0;
}

void CharacterStream::Flush(SampleSink& sink) {
  is_confirmed_ = true;
  FinishAll(sink);
  DropDoubtful();
  AnnounceOnce(sink);
}

void CharacterStream::Discard() {
  DropDoubtful();
  for (OpenSample& open : open_) {
    if (open.is_open) tally_->outliers += open.sample.datagrams();
    open.is_open = false;
  }
}

CharacterStream::OpenSample* CharacterStream::Find(std::uint32_t counter) {
  for (OpenSample& open : open_) {
    if (open.is_open && open.sample.counter() == counter) return &open;
  }
  return nullptr;
}

const CharacterStream::OpenSample* CharacterStream::Find(std::uint32_t counter) const {
  return const_cast<CharacterStream*>(this)->Find(counter);
}

CharacterStream::OpenSample* CharacterStream::Oldest() {
  OpenSample* oldest = nullptr;
  for (OpenSample& open : open_) {
    if (!open.is_open) continue;
    if (oldest == nullptr || Ahead(oldest->sample.counter(), open.sample.counter()) > 0) {
      oldest = &open;
    }
  }
  return oldest;
}

CharacterStream::OpenSample& CharacterStream::Open(const Message& message, const Arrival& arrival,
                                                   SampleSink& sink) {
  const auto is_free = [](const OpenSample& open) { return !open.is_open; };
  if (std::none_of(open_.begin(), open_.end(), is_free)) Finish(*Oldest(), sink);
  OpenSample& open = *std::find_if(open_.begin(), open_.end(), is_free);
  open.is_open = true;
  open.sample.Begin(message.header, arrival);
  if (!newest_ || Ahead(message.header.sample_counter, *newest_) > 0) {
    if (!newest_) run_start_ = message.header.sample_counter;
    newest_ = message.header.sample_counter;
    line_.Add(message.header.sample_counter, message.header.time_code_millis);
    MeasurePeriod(message.header.time_code_millis, arrival.monotonic_nanos);
  }
  return open;
}

// Uses the sender's clock, which bursts do not compress; the receive time if that clock stands
// still.
void CharacterStream::MeasurePeriod(std::uint32_t time_code_millis, std::int64_t now) {
  if (last_begin_) {
    const std::int32_t millis = Ahead(time_code_millis, last_begin_->time_code_millis);
    const auto interval =
        millis > 0 ? millis * 1e6 : static_cast<double>(now - last_begin_->arrival_nanos);
    if (interval < kLongestInterval) {
      period_nanos_ =
          period_nanos_ ? *period_nanos_ + kPeriodGain * (interval - *period_nanos_) : interval;
    }
  }
  last_begin_ = Begun{time_code_millis, now};
}

void CharacterStream::FinishUpTo(std::uint32_t counter, SampleSink& sink) {
  for (OpenSample* oldest = Oldest();
       oldest != nullptr && Ahead(oldest->sample.counter(), counter) <= 0; oldest = Oldest()) {
    Finish(*oldest, sink);
  }
}

// Finishes a sample that will not become more complete: a newer one has every type that it has, and
// enough datagrams have followed.
void CharacterStream::FinishOvertakenBy(const PendingSample& newer, SampleSink& sink) {
  if (types_.are_known() && newer.datagrams() <= kPlacesReordered) return;
  for (OpenSample& open : open_) {
    if (!open.is_open || Ahead(newer.counter(), open.sample.counter()) <= 0) continue;
    if ((open.sample.begun() & ~newer.whole()).none()) FinishUpTo(open.sample.counter(), sink);
  }
}

void CharacterStream::FinishAll(SampleSink& sink) {
  for (OpenSample* oldest = Oldest(); oldest != nullptr; oldest = Oldest()) Finish(*oldest, sink);
}

void CharacterStream::Finish(OpenSample& open, SampleSink& sink) {
  const PendingSample& sample = open.sample;
  open.is_open = false;
  if (closed_) {
    const auto step = static_cast<std::uint32_t>(Ahead(sample.counter(), *closed_));
    if (steps_.IsGap(step)) ++tally_->counter_gaps;
    steps_.Add(step);
    tally_->lost += losses_.Add(step);
  }
  closed_ = sample.counter();
  history_.Add(sample);
  tally_->mismatched_ids += static_cast<std::uint64_t>(sample.mismatched_ids());
  const bool is_incomplete = types_.IsAnyMissingIn(sample.begun());
  types_.Learn(sample.begun());
  const bool has_pose = sample.HasPose();
  if (!has_pose && !sample.HasObjects()) {
    return tally_->Reject(Reason::kNoWholePose, sample.datagrams());
  }
  ++tally_->samples;
  tally_->in_samples += sample.datagrams();
  if (is_incomplete) ++tally_->incomplete;
  has_given_ = true;
  last_given_nanos_ = sample.first_arrival().monotonic_nanos;
  AnnounceOnce(sink);
  const std::int64_t stamp = StampOf(sample);
  if (has_pose) {
    BodySample body = sample.TakeBody();
    body.character = character_.id;
    body.stamp_nanos = stamp;
    sink.OnSample(body);
  } else {
    ObjectsSample objects = sample.TakeObjects();
    objects.character = character_.id;
    objects.stamp_nanos = stamp;
    sink.OnObjects(objects);
  }
}

std::int64_t CharacterStream::StampOf(const PendingSample& sample) {
  const std::int64_t fitted =
      clock_.Stamp(sample.counter(), sample.time_code_millis(), sample.first_arrival());
  tally_->delays.Add(std::max<std::int64_t>(sample.first_arrival().wall_nanos - fitted, 0));
  return settings_.stamps == Stamps::kFitted ? fitted : sample.first_arrival().wall_nanos;
}

std::int64_t CharacterStream::PatienceNanos() const {
  if (settings_.delivery == Delivery::kComplete) return kPatienceOfFiles;
  return static_cast<std::int64_t>(
      period_nanos_ ? std::clamp(kPatienceInPeriods * *period_nanos_, kMinPatience, kMaxPatience)
                    : kFirstPatience);
}

std::optional<std::int64_t> CharacterStream::deadline_nanos() const {
  auto deadline = scale_.deadline_nanos();
  const auto consider = [&](std::int64_t nanos) {
    deadline = deadline ? std::min(*deadline, nanos) : nanos;
  };
  if (doubtful_) consider(doubtful_->arrival.monotonic_nanos + kDoubtNanos);
  if (!is_confirmed_) return deadline;
  for (const OpenSample& open : open_) {
    if (open.is_open) consider(open.sample.first_arrival().monotonic_nanos + PatienceNanos());
  }
  return deadline;
}

void CharacterStream::Expire(std::int64_t now_nanos, SampleSink& sink) {
  if (doubtful_ && now_nanos >= doubtful_->arrival.monotonic_nanos + kDoubtNanos) DropDoubtful();
  TakeScale(now_nanos, sink);
  if (!is_confirmed_) return;
  for (OpenSample& open : open_) {
    if (open.is_open &&
        now_nanos >= open.sample.first_arrival().monotonic_nanos + PatienceNanos()) {
      FinishUpTo(open.sample.counter(), sink);
    }
  }
}

}  // namespace kinescope::mvn
