/// JSON as text. Names of files and people come from outside and may hold any bytes; JSON is UTF-8,
/// so bytes that are none become U+FFFD instead of an exception.
#pragma once

#include <string>

namespace kinescope {

enum class JsonBytes {
  kUtf8,
  kAscii,  // everything else escaped
};

/// `json`: nlohmann::json or ordered_json. `indent`: spaces for each level; -1: all in one line.
template <class Json>
std::string JsonText(const Json& json, int indent = -1, JsonBytes bytes = JsonBytes::kUtf8) {
  return json.dump(indent, ' ', bytes == JsonBytes::kAscii, Json::error_handler_t::replace);
}

}  // namespace kinescope
