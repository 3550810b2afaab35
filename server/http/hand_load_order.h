/// Parses the body of POST /api/v1/hand_load (docs/http.md). Pure function, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/force_inputs.h"

namespace kinescope::http {

struct HandLoadOrder {
  std::optional<int> person;  // character whose hands are meant; absent: the only person
  HandLoad load;
};

/// One JSON object with "right_kg", "left_kg", "both_kg" (absent: 0), "right_com_m" and
/// "left_com_m" (x, y, z; absent: at the grip point) and "person". Numbers must be finite; their
/// range is not checked here. The reason of an error is one line for the client. Unknown members
/// are rejected, so that a misspelt hand does not count as an empty one.
[[nodiscard]] tl::expected<HandLoadOrder, std::string> ParseHandLoadOrder(std::string_view body);

}  // namespace kinescope::http
