#include "server/app/serve/change_mailbox.h"

#include <utility>

#include "server/loads/load_meter.h"

namespace kinescope::app {

void ChangeMailbox::Put(int character, const PersonChange& change) {
  const std::lock_guard<std::mutex> lock(mutex_);
  people_[character].Add(change);
}

void ChangeMailbox::Put(const std::array<double, 2>& class_limits) {
  const std::lock_guard<std::mutex> lock(mutex_);
  class_limits_ = class_limits;
}

void ChangeMailbox::PassTo(SceneBuilder& builder) {
  std::map<int, PersonChange> people;
  std::optional<std::array<double, 2>> class_limits;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    people = std::exchange(people_, {});
    class_limits = std::exchange(class_limits_, std::nullopt);
  }
  for (const auto& [character, change] : people) builder.ChangePerson(character, change);
  if (!class_limits) return;
  loads::LoadSettings settings = builder.loads();
  const bool is_momentary = settings.meter.is_momentary;
  settings.meter = loads::LoadMeter::WithLimits(*class_limits);
  settings.meter.is_momentary = is_momentary;
  builder.SetLoads(settings);
}

}  // namespace kinescope::app
