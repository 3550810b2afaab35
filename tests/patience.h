/// How long a test waits for what comes soon.
#pragma once

#include <chrono>

namespace kinescope::testing {

inline constexpr std::chrono::seconds kPatience(60);  // only a failure takes so long

}  // namespace kinescope::testing
