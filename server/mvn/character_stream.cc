#include "server/mvn/character_stream.h"

#include <algorithm>
#include <variant>

namespace kinescope::mvn {
namespace {

constexpr int kSamplesToLearnTypes = 3;
constexpr int kMissesToForgetType = 5;
constexpr double kPeriodGain = 1.0 / 16;
constexpr double kLongestInterval = 0.5e9;  // a pause is no period
constexpr double kPatienceInPeriods = 1.5;
constexpr double kLeastPatience = 5e6;
constexpr double kMostPatience = 100e6;
constexpr double kFirstPatience = 50e6;  // before the period is known

}  // namespace

void CharacterStream::Add(const Message& message, const Arrival& arrival, SampleSink& sink) {
  last_heard_nanos_ = arrival.monotonic_nanos;
  // Types 12 and 13 carry counter and time code 0 in the middle of a stream: they never touch the
  // sample's logic.
  if (const auto* meta = std::get_if<MetaDataMessage>(&message.body)) {
    AddMetaData(*meta, sink);
  } else if (std::holds_alternative<ScaleMessage>(message.body)) {
    AddScale(message, arrival.monotonic_nanos, sink);
  } else {
    AddToSample(message, arrival, sink);
  }
}

void CharacterStream::AddMetaData(const MetaDataMessage& body, SampleSink& sink) {
  ++tally_->in_characters;
  const bool changed = (body.name && *body.name != character_.name) ||
                       (body.color_rgb && body.color_rgb != character_.color_rgb);
  if (body.name) character_.name = *body.name;
  if (body.color_rgb) character_.color_rgb = body.color_rgb;
  if (changed || !announced_) Announce(sink);
}

void CharacterStream::AddScale(const Message& message, std::int64_t now_nanos, SampleSink& sink) {
  const auto refused = scale_.Add(message.header, std::get<ScaleMessage>(message.body), now_nanos);
  if (refused) return tally_->Reject(*refused);
  ++tally_->in_characters;
  TakeSkeleton(now_nanos, sink);
}

void CharacterStream::TakeSkeleton(std::int64_t now_nanos, SampleSink& sink) {
  const auto skeleton = scale_.TakeSkeleton(now_nanos);
  if (!skeleton || (character_.skeleton && *character_.skeleton == *skeleton)) return;
  character_.skeleton = skeleton;
  Announce(sink);
}

void CharacterStream::Announce(SampleSink& sink) {
  announced_ = true;
  sink.OnCharacter(character_);
}

void CharacterStream::AddToSample(const Message& message, const Arrival& arrival,
                                  SampleSink& sink) {
  switch (counters_.Take(message.header.sample_counter, arrival.monotonic_nanos)) {
    case CounterTracker::Order::kLate: ++tally_->late; return;
    case CounterTracker::Order::kRestart:
      ++tally_->restarts;
      Finish(sink);
      clock_.Restart();
      Begin(message, arrival);
      break;
    case CounterTracker::Order::kNewer:
      if (counters_.last_step_was_gap()) ++tally_->counter_gaps;
      Finish(sink);
      Begin(message, arrival);
      break;
    case CounterTracker::Order::kSame:
      if (!open_) return AddToClosedSample(message);
      break;
  }
  switch (pending_.Add(message, arrival.monotonic_nanos)) {
    case PendingSample::Added::kDuplicate: ++tally_->duplicates; return;
    case PendingSample::Added::kContradiction: tally_->Reject(Reason::kPartsContradict); return;
    case PendingSample::Added::kYes: break;
  }
  if (IsComplete()) Finish(sink);
}

void CharacterStream::AddToClosedSample(const Message& message) {
  if (pending_.Has(message)) {
    ++tally_->duplicates;
    return;
  }
  ++tally_->late;
  // A type that has just been switched on comes after a sample that did not wait for it.
  const auto type = static_cast<std::size_t>(PendingSample::TypeOf(message));
  expected_.set(type);
  missed_[type] = 0;
}

void CharacterStream::Begin(const Message& message, const Arrival& arrival) {
  const std::int64_t now = arrival.monotonic_nanos;
  if (last_begin_nanos_) {
    const auto interval = static_cast<double>(now - *last_begin_nanos_);
    if (interval < kLongestInterval) {
      period_nanos_ =
          period_nanos_ ? *period_nanos_ + kPeriodGain * (interval - *period_nanos_) : interval;
    }
  }
  last_begin_nanos_ = now;
  pending_.Begin(message.header, arrival);
  open_ = true;
}

bool CharacterStream::IsComplete() const {
  return finished_ >= kSamplesToLearnTypes && (expected_ & ~pending_.whole()).none() &&
         pending_.HasPose();
}

void CharacterStream::Finish(SampleSink& sink) {
  if (!open_) return;
  open_ = false;
  const SampleTypes begun = pending_.begun();
  if (!pending_.HasPose()) {
    tally_->Reject(Reason::kNoWholePose, pending_.datagrams());
    return LearnTypes(begun);
  }
  ++tally_->samples;
  tally_->in_samples += pending_.datagrams();
  if ((expected_ & ~begun).any()) ++tally_->incomplete;
  LearnTypes(begun);
  if (!announced_) Announce(sink);
  BodySample sample = pending_.Take();
  sample.character = character_.id;
  sample.stamp_nanos =
      clock_.Stamp(sample.counter, static_cast<std::uint32_t>(sample.time_code_millis),
                   pending_.first_arrival());
  sink.OnSample(sample);
}

void CharacterStream::LearnTypes(SampleTypes begun) {
  finished_ = std::min(finished_ + 1, kSamplesToLearnTypes);
  for (std::size_t type = 0; type < kSampleTypeCount; ++type) {
    if (begun.test(type)) {
      expected_.set(type);
      missed_[type] = 0;
    } else if (expected_.test(type) && ++missed_[type] >= kMissesToForgetType) {
      expected_.reset(type);
    }
  }
}

std::int64_t CharacterStream::PatienceNanos() const {
  return static_cast<std::int64_t>(
      period_nanos_ ? std::clamp(kPatienceInPeriods * *period_nanos_, kLeastPatience, kMostPatience)
                    : kFirstPatience);
}

std::optional<std::int64_t> CharacterStream::deadline_nanos() const {
  auto deadline = scale_.deadline_nanos();
  if (open_) {
    const std::int64_t sample = pending_.first_arrival().monotonic_nanos + PatienceNanos();
    deadline = deadline ? std::min(*deadline, sample) : sample;
  }
  return deadline;
}

void CharacterStream::Expire(std::int64_t now_nanos, SampleSink& sink) {
  if (open_ && now_nanos >= pending_.first_arrival().monotonic_nanos + PatienceNanos()) {
    Finish(sink);
  }
  TakeSkeleton(now_nanos, sink);
}

void CharacterStream::SenderRestarted(SampleSink& sink) {
  Finish(sink);
  counters_.Forget();
  clock_.Restart();
}

}  // namespace kinescope::mvn
