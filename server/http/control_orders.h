/// The bodies of the POST requests of controls (docs/http.md). The reason of an error is one line
/// for the client. Unknown members are rejected. Pure functions, any thread.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "server/http/controls.h"

namespace kinescope::http {

/// Of a name, a condition or a label, in characters.
inline constexpr std::size_t kLongestLabel = 60;

template <class Order>
using Parsed = tl::expected<Order, std::string>;

[[nodiscard]] Parsed<RecordingOrder> ParseRecordingOrder(std::string_view body);
[[nodiscard]] Parsed<ClipOrder> ParseClipOrder(std::string_view body);
[[nodiscard]] Parsed<PersonOrder> ParsePersonOrder(std::string_view body);
/// Rising ratios; their range is not checked here.
[[nodiscard]] Parsed<std::array<double, 2>> ParseLimitsOrder(std::string_view body);
[[nodiscard]] Parsed<TrialOrder> ParseTrialOrder(std::string_view body);

}  // namespace kinescope::http
