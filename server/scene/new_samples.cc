#include "server/scene/new_samples.h"

namespace kinescope::app {

bool NewSamples::IsNew(const PersonState& person) {
  const std::pair<std::int64_t, std::uint32_t> now = {person.sample.stamp_nanos,
                                                      person.sample.counter};
  const auto [found, is_first] = last_.try_emplace(person.character, now);
  if (!is_first && found->second == now) return false;
  found->second = now;
  return true;
}

}  // namespace kinescope::app
