/// Option values as JSON, the same in provenance and in the output of commands. Pure functions, any
/// thread.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "server/options/value.h"

namespace kinescope::app {

/// A text, a number or a truth; a list of texts if the option is repeatable; null if the value is
/// not given.
nlohmann::json ToJson(const options::Value& value);

}  // namespace kinescope::app
