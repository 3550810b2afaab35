/// Verdicts as JSON: what `golden check --json` prints, run.json keeps and the processes that draw
/// send. Pure but for looking which pictures are there; any thread.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// For people's programs, with numbers and the paths of the pictures in `out`. Members `case`,
/// `outcome`, `problems`, `findings`, `layers`, ...
nlohmann::ordered_json ToJson(const CaseVerdict& verdict, const std::filesystem::path& out);

/// The same with all that VerdictFrom() needs.
nlohmann::ordered_json ToWholeJson(const CaseVerdict& verdict, const std::filesystem::path& out);

/// @throws std::exception with the reason if a member is missing, of another type or not plausible.
CaseVerdict VerdictFrom(const nlohmann::json& json);

}  // namespace kinescope::app
