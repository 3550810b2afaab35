/// `golden new` and `golden keys`: writes cases, and explains what they may contain. One thread.
#pragma once

#include <filesystem>
#include <string>

#include "server/app/golden/golden_case.h"
#include "server/options/option_list.h"

namespace kinescope::app {

/// Writes `<folder>/<name>.yaml` with those of `options` that were given; files in it are relative
/// to it. Returns its path.
/// @throws UsageError with the name if it is no file name, if there is such a case already, or if
/// the case could not be read again; std::runtime_error if it cannot be written.
std::filesystem::path WriteNewCase(const std::filesystem::path& folder, const std::string& name,
                                   const options::OptionList& options);

/// Prints the keys of cases with their defaults and what they take.
void PrintKeys(bool as_json);

}  // namespace kinescope::app
