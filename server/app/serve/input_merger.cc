#include "server/app/serve/input_merger.h"

namespace kinescope::app {

void InputMerger::TakeInputs() {
  if (ros_ != nullptr) ros_->TakeInputs(*this);
  for (const auto& [character, load] : hand_loads_.TakeAll()) {
    builder_.SetHandLoad(character, load);
  }
  if (changes_ != nullptr) changes_->PassTo(builder_);
}

void InputMerger::OnSample(const BodySample& sample) {
  const std::int64_t now = now_();
  const std::int64_t waited = Overload::WaitedNanos(sample, now);
  has_samples_ = true;
  if (!overload_.Admit(sample.character, waited, now)) {
    skipped_.insert_or_assign(sample.character, sample);
    return;
  }
  skipped_.erase(sample.character);
  Process(sample, waited);
}

void InputMerger::Process(const BodySample& sample, std::int64_t waited_nanos) {
  TakeInputs();
  builder_.SetWaited(waited_nanos);
  builder_.OnSample(sample);
}

void InputMerger::AfterPoll() {
  if (std::exchange(has_samples_, false)) return;
  for (const auto& [character, sample] : skipped_) Process(sample, 0);
  skipped_.clear();
  overload_.OnIdle(now_());
  builder_.OnCaughtUp();
}

void InputMerger::OnHandLoad(int character, const HandLoad& load) {
  builder_.SetHandLoad(character, load);
  if (on_hand_load_) on_hand_load_(character, load);
}

void InputMerger::OnMeasurements(int character, const Measurements& measured) {
  builder_.SetMeasurements(character, measured);
}

void InputMerger::OnMark(const std::string& text) {
  if (on_mark_) on_mark_(text);
}

void InputMerger::OnViewListeners(int count) {
  if (on_subscribers_) on_subscribers_(count);
}

}  // namespace kinescope::app
