#include "core/system/json_text.h"

#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string_view>

namespace kinescope {
namespace {

struct Escape {
  std::size_t bytes = 0;  // that it replaces; 0: none
  std::string_view prefix;
  unsigned char last = 0;  // of the code point
};

// What begins at the first byte of `text`, which is valid UTF-8.
Escape EscapeOf(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : static_cast<unsigned char>(0);
  };
  const unsigned char second = byte(1), third = byte(2);
  if (byte(0) == 0x7F) return {1, "\\u00", 0x7F};
  if (byte(0) == 0xC2 && second < 0xA0) return {2, "\\u00", second};
  if (byte(0) != 0xE2) return {};
  const auto in_block = static_cast<unsigned char>((second & 1U) << 6 | (third & 0x3FU));
  if (second == 0x80 && third >= 0xAA && third <= 0xAE) return {3, "\\u20", in_block};
  if (second == 0x81 && third >= 0xA6 && third <= 0xA9) return {3, "\\u20", in_block};
  return {};
}

template <class Json>
std::string TextOf(const Json& json, int indent, JsonBytes bytes) {
  return EscapeControls(
      json.dump(indent, ' ', bytes == JsonBytes::kAscii, Json::error_handler_t::replace));
}

}  // namespace

std::string EscapeControls(std::string json) {
  const auto may_begin = [](char c) { return c == '\x7F' || c == '\xC2' || c == '\xE2'; };
  if (std::none_of(json.begin(), json.end(), may_begin)) return json;
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string escaped;
  for (std::size_t at = 0; at < json.size();) {
    const Escape escape = EscapeOf(std::string_view(json).substr(at));
    if (escape.bytes == 0) {
      escaped += json[at++];
      continue;
    }
    escaped += escape.prefix;
    escaped += kDigits[escape.last >> 4];
    escaped += kDigits[escape.last & 0xF];
    at += escape.bytes;
  }
  return escaped;
}

std::string JsonText(const nlohmann::json& json, int indent, JsonBytes bytes) {
  return TextOf(json, indent, bytes);
}

std::string JsonText(const nlohmann::ordered_json& json, int indent, JsonBytes bytes) {
  return TextOf(json, indent, bytes);
}

}  // namespace kinescope
