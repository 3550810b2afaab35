/// Writes JSON as text. Names of files and persons are untrusted and may contain any bytes; invalid
/// UTF-8 becomes U+FFFD instead of an exception.
#pragma once

#include <string>

namespace kinescope {

enum class JsonBytes {
  kUtf8,
  kAscii,  // all other characters are escaped
};

/// `json`: nlohmann::json or ordered_json. `indent`: spaces per level; -1: everything on one line.
template <class Json>
std::string JsonText(const Json& json, int indent = -1, JsonBytes bytes = JsonBytes::kUtf8) {
  return json.dump(indent, ' ', bytes == JsonBytes::kAscii, Json::error_handler_t::replace);
}

}  // namespace kinescope
