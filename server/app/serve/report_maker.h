/// Makes the report of a trial: `kinescope loads` in a process of its own, so that whatever a
/// recording contains, the server goes on. For the workshop's thread.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "server/app/serve/serve_options.h"
#include "server/app/serve/workshop.h"

namespace kinescope::app {

/// Options of `kinescope loads`: name and value.
using OptionTexts = std::vector<std::pair<std::string, std::string>>;

/// Those of the person and the loads that differ from their defaults.
OptionTexts LoadsOptionsOf(const PersonOptions& person, const LoadOptions& loads);

/// In the place of one of the same name, or added.
void SetOption(OptionTexts& options, const std::string& name, const std::string& value);

/// "name=value", one per line, and back. Lines that name no option of the person or the loads are
/// left out: they come from a file.
std::string ToLines(const OptionTexts& options);
OptionTexts OptionsFromLines(const std::string& lines);

/// @throws std::exception with the last line of the program's error
void MakeReport(const std::filesystem::path& recording, const std::filesystem::path& report,
                const OptionTexts& options, const Workshop::Progress& progress);

}  // namespace kinescope::app
