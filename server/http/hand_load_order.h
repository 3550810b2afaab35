/// The body of POST /api/hand_load (docs/http.md). Pure function, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "core/force_inputs.h"

namespace kinescope::http {

struct HandLoadOrder {
  std::optional<int> person;  // whose hands, by character; absent: the only one's
  HandLoad load;
};

/// One JSON object of "right_kg", "left_kg", "both_kg" (what is absent is 0), "right_com_m" and
/// "left_com_m" (x, y, z; what is absent is at the grip) and "person". Numbers are not judged here,
/// but that they are finite. The reason is one line for the client. Members that are not known are
/// refused, so that a misspelt hand is not an empty one.
[[nodiscard]] tl::expected<HandLoadOrder, std::string> ParseHandLoadOrder(std::string_view body);

}  // namespace kinescope::http
