/// Writes JSON as text. Names of files and persons are untrusted and may contain any bytes; invalid
/// UTF-8 becomes U+FFFD instead of an exception, and characters that steer a terminal are escaped.
#pragma once

#include <cmath>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace kinescope {

enum class JsonBytes {
  kUtf8,
  kAscii,  // all other characters are escaped
};

/// `json` with DEL, C1 and the characters that reverse a text as \u escapes; C0 has them already.
std::string EscapeControls(std::string json);

/// `indent`: spaces per level; -1: everything on one line.
std::string JsonText(const nlohmann::json& json, int indent = -1,
                     JsonBytes bytes = JsonBytes::kUtf8);
std::string JsonText(const nlohmann::ordered_json& json, int indent = -1,
                     JsonBytes bytes = JsonBytes::kUtf8);

/// JSON has no NaN; null means unknown. `Json`: one of these two.
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
