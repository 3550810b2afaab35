/// Option values as JSON, the same in provenance and in the output of commands. Any thread.
#pragma once

#include <nlohmann/json.hpp>

#include "server/options/option_list.h"

namespace kinescope::options {

/// A text, a number or a truth; a list of texts if the option is repeatable; null if the value is
/// not given.
nlohmann::json ToJson(const Value& value);

/// Options that were given or have a default, by name.
nlohmann::ordered_json ValuesOf(const OptionList& list);

/// The files that the options read, with their SHA-256: members `option`, `name`, `sha256`,
/// `bytes`.
/// @throws SourceError
nlohmann::ordered_json InputsOf(const OptionList& list);

}  // namespace kinescope::options
