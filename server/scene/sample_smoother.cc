#include "server/scene/sample_smoother.h"

#include <utility>

#include "core/system/clocks.h"

namespace kinescope::app {
namespace {

double LongestGapSecs() {
  static const double secs = loads::MotionFilter::Settings().longest_gap_secs;
  return secs;
}

}  // namespace

void SampleSmoother::OnCharacter(const Character& character) {
  waiting_.push_back({character, false});
  PassOn();
}

void SampleSmoother::OnObjects(const ObjectsSample& sample) {
  waiting_.push_back({sample, false});
  PassOn();
}

void SampleSmoother::OnSurroundings(const RecordedSurroundings& all) {
  waiting_.push_back({all, false});
  PassOn();
}

// People who have left keep nothing waiting.
void SampleSmoother::OnMoment(const SourceMoment& moment) {
  for (auto& [character, person] : people_) {
    if (!person.continues || Secs(moment.stamp_nanos - person.last_nanos) <= LongestGapSecs()) {
      continue;
    }
    person.filter.End();
    person.continues = false;
  }
  waiting_.push_back({moment, false});
  PassOn();
}

// A repeated stamp has no motion of its own; a gap and a sample without motion end that before
// them.
void SampleSmoother::OnSample(const BodySample& sample) {
  Person& person = people_.try_emplace(sample.character, cutoff_hz_).first->second;
  const double step = Secs(sample.stamp_nanos - person.last_nanos);
  const bool is_repeated = person.continues && step == 0;
  const bool has_motion = !is_repeated && loads::WhatIsMissing(sample).empty();
  if (person.continues && !is_repeated && (!has_motion || step < 0 || step > LongestGapSecs())) {
    person.filter.End();
    person.continues = false;
  }
  waiting_.push_back({sample, has_motion});
  if (has_motion) {
    person.filter.Add(sample);
    person.continues = true;
    person.last_nanos = sample.stamp_nanos;
  }
  PassOn();
}

void SampleSmoother::End() {
  for (auto& [character, person] : people_) person.filter.End();
  PassOn();
}

void SampleSmoother::PassOn() {
  while (!waiting_.empty()) {
    const Waiting& next = waiting_.front();
    if (const auto* const sample = std::get_if<BodySample>(&next.event)) {
      if (next.has_motion) {
        auto& ready = people_.at(sample->character).filter.ready();
        if (ready.empty()) return;
        to_.OnSample(*sample, &ready.front());
        ready.pop_front();
      } else {
        to_.OnSample(*sample, nullptr);
      }
    } else if (const auto* const character = std::get_if<Character>(&next.event)) {
      to_.OnCharacter(*character);
    } else if (const auto* const surroundings = std::get_if<RecordedSurroundings>(&next.event)) {
      to_.OnSurroundings(*surroundings);
    } else if (const auto* const moment = std::get_if<SourceMoment>(&next.event)) {
      to_.OnMoment(*moment);
    } else {
      to_.OnObjects(std::get<ObjectsSample>(next.event));
    }
    waiting_.pop_front();
  }
}

}  // namespace kinescope::app
