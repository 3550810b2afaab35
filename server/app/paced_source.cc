#include "server/app/paced_source.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include "server/app/clocks.h"

namespace kinescope::app {

PacedSource::PacedSource(Open open, bool loop)
    : open_(std::move(open)), loop_(loop), source_(open_()) {}

void PacedSource::OnCharacter(const Character& character) {
  characters_to_->OnCharacter(character);
}

void PacedSource::OnSample(const BodySample& sample) { next_ = sample; }

bool PacedSource::ReadNext(SampleSink& sink) {
  characters_to_ = &sink;
  bool has_rewound = false;
  while (!next_) {
    if (source_->Poll(std::chrono::milliseconds(0), *this) == State::kMore) continue;
    if (next_) break;
    if (!loop_ || has_rewound || !has_started_) return false;  // twice at the end: it is empty
    has_rewound = true;
    const double rate = source_->nominal_rate_hz();
    const auto period = rate > 0 ? static_cast<std::int64_t>(1e9 / rate) : 0;
    round_offset_ += last_stamp_ - first_stamp_ + period;
    counter_offset_ = last_counter_ + 1;
    at_round_start_ = true;
    source_ = open_();
  }
  if (at_round_start_) {
    at_round_start_ = false;
    first_stamp_ = next_->stamp_nanos;
  }
  return true;
}

std::int64_t PacedSource::DueNanos() const {
  return start_monotonic_ + round_offset_ + (next_->stamp_nanos - first_stamp_);
}

BodySample PacedSource::AsIfNow(const BodySample& sample) const {
  BodySample now = sample;
  const std::int64_t played = round_offset_ + (sample.stamp_nanos - first_stamp_);
  now.stamp_nanos = start_wall_ + played;
  now.arrival_nanos = MonotonicNanos();
  now.counter = sample.counter + counter_offset_;
  now.time_code_millis = sample.time_code_millis + round_offset_ / 1'000'000;
  return now;
}

Source::State PacedSource::Poll(std::chrono::milliseconds timeout, SampleSink& sink) {
  const std::int64_t deadline = MonotonicNanos() + timeout.count() * 1'000'000;
  if (!next_ && !ReadNext(sink)) return State::kEnded;
  if (!has_started_) {
    has_started_ = true;
    start_monotonic_ = MonotonicNanos();
    start_wall_ = WallNanos();
  }
  const std::int64_t due = DueNanos();
  // A file's samples are due at known times; there is no event to wait for but the clock.
  const std::int64_t wait = std::min(due, deadline) - MonotonicNanos();
  if (wait > 0) std::this_thread::sleep_for(std::chrono::nanoseconds(wait));
  if (due > deadline) return State::kMore;

  const BodySample sample = *std::exchange(next_, std::nullopt);
  last_stamp_ = sample.stamp_nanos;
  last_counter_ = sample.counter + counter_offset_;
  ++counters_.samples;
  sink.OnSample(AsIfNow(sample));
  return State::kMore;
}

}  // namespace kinescope::app
