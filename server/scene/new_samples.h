/// Says which people of a scene have a new sample: a scene has all people, but each sample is of
/// one. One thread.
#pragma once

#include <cstdint>
#include <map>
#include <utility>

#include "core/scene_state.h"

namespace kinescope::app {

class NewSamples {
 public:
  /// Once per sample. `person`: of the next scene, in their order.
  bool IsNew(const PersonState& person);

 private:
  std::map<int, std::pair<std::int64_t, std::uint32_t>> last_;  // stamp and counter, by character
};

}  // namespace kinescope::app
