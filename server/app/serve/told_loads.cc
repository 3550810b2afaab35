#include "server/app/serve/told_loads.h"

#include <utility>

#include "server/loads/hand_loads.h"

namespace kinescope::app {

std::string ToldLoads::Tell(int character, const HandLoad& load) {
  std::string wrong = loads::FindDefect(load);
  if (!wrong.empty()) return wrong;
  const std::lock_guard<std::mutex> lock(mutex_);
  told_[character] = load;
  return "";
}

std::map<int, HandLoad> ToldLoads::Take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(told_, {});
}

void InputsFirst::TakeInputs() {
  if (ros_ != nullptr) ros_->TakeInputs(*this);
  for (const auto& [character, load] : told_.Take()) builder_.SetHandLoad(character, load);
}

void InputsFirst::OnSample(const BodySample& sample) {
  TakeInputs();
  builder_.OnSample(sample);
}

void InputsFirst::OnHandLoad(int character, const HandLoad& load) {
  builder_.SetHandLoad(character, load);
}

void InputsFirst::OnMeasurements(int character, const Measurements& measured) {
  builder_.SetMeasurements(character, measured);
}

void InputsFirst::OnMarkers(const std::vector<std::shared_ptr<const SceneMarker>>& markers) {
  builder_.SetMarkers(markers);
}

void InputsFirst::OnViewListeners(int count) {
  if (view_ != nullptr) view_->SetSubscribers(count);
}

}  // namespace kinescope::app
