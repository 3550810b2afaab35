/// Writes JSON as text. Names of files and persons are untrusted and may contain any bytes; invalid
/// UTF-8 becomes U+FFFD instead of an exception, and characters that steer a terminal are escaped.
#pragma once

#include <cmath>
#include <string>

namespace kinescope {

enum class JsonBytes {
  kUtf8,
  kAscii,  // all other characters are escaped
};

/// `json` with DEL, C1 and the characters that reverse a text as \u escapes; C0 has them already.
std::string EscapeControls(std::string json);

/// `json`: nlohmann::json or ordered_json. `indent`: spaces per level; -1: everything on one line.
template <class Json>
std::string JsonText(const Json& json, int indent = -1, JsonBytes bytes = JsonBytes::kUtf8) {
  return EscapeControls(
      json.dump(indent, ' ', bytes == JsonBytes::kAscii, Json::error_handler_t::replace));
}

/// JSON has no NaN; null means unknown. `Json` as above.
template <class Json>
Json NumberOrNull(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// `value` as the nearest multiple of 1 / `per_unit`: short, and the same text while it changes
/// less.
inline double Rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

}  // namespace kinescope
