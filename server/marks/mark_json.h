/// A mark as a JSON object: a line of the file, an entry of /api/v1/marks (docs/http.md). Any
/// thread.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "server/marks/mark.h"

namespace kinescope::marks {

nlohmann::json ToJson(const Mark& mark);

/// nullopt if `line` is no mark as ToJson() writes it.
std::optional<Mark> ReadMark(std::string_view line);

}  // namespace kinescope::marks
