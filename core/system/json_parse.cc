#include "core/system/json_parse.h"

namespace kinescope {

nlohmann::json ParseJson(std::string_view text) {
  return nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
}

nlohmann::ordered_json ParseOrderedJson(std::string_view text) {
  return nlohmann::ordered_json::parse(text, nullptr, /*allow_exceptions=*/false);
}

nlohmann::json ParseJsonOrThrow(std::string_view text,
                                const nlohmann::json::parser_callback_t& callback) {
  return nlohmann::json::parse(text, callback);
}

}  // namespace kinescope
