/// Parses JSON in one place: nlohmann's parser is a template that costs a compiler seconds in every
/// source that calls it. Any thread.
#pragma once

#include <nlohmann/json.hpp>
#include <string_view>

namespace kinescope {

/// A discarded value (is_discarded()) if `text` is not JSON.
nlohmann::json ParseJson(std::string_view text);
nlohmann::ordered_json ParseOrderedJson(std::string_view text);

/// `callback`: as that of nlohmann::json::parse. @throws nlohmann::json::parse_error, and what
/// `callback` throws.
nlohmann::json ParseJsonOrThrow(std::string_view text,
                                const nlohmann::json::parser_callback_t& callback = nullptr);

}  // namespace kinescope
