#include "server/app/serve/input_merger.h"

namespace kinescope::app {

void InputMerger::TakeInputs() {
  if (ros_ != nullptr) ros_->TakeInputs(*this);
  for (const auto& [character, load] : hand_loads_.TakeAll()) {
    builder_.SetHandLoad(character, load);
  }
}

void InputMerger::OnSample(const BodySample& sample) {
  TakeInputs();
  builder_.OnSample(sample);
}

void InputMerger::OnHandLoad(int character, const HandLoad& load) {
  builder_.SetHandLoad(character, load);
}

void InputMerger::OnMeasurements(int character, const Measurements& measured) {
  builder_.SetMeasurements(character, measured);
}

void InputMerger::OnMarkers(const std::vector<std::shared_ptr<const SceneMarker>>& markers) {
  builder_.SetMarkers(markers);
}

void InputMerger::OnViewListeners(int count) {
  if (on_subscribers_) on_subscribers_(count);
}

}  // namespace kinescope::app
