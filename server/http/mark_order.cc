#include "server/http/mark_order.h"

#include <nlohmann/json.hpp>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/utf8.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

constexpr char kExpectedMark[] =
    "expected {\"state\": NUMBER, \"button\": 1 to 9} or {\"state\": NUMBER, \"text\": TEXT}, both "
    "also with \"is_span\": true; {\"id\": NUMBER, \"state\": NUMBER} to end a span; or {\"id\": "
    "NUMBER, \"remove\": true}";

std::string Quote(const std::string& key) {
  constexpr std::size_t kMaxShown = 40;  // bytes
  return JsonText(json(key.substr(0, kMaxShown)));
}

bool IsCount(const json& value) {
  return value.is_number_unsigned() && value.get<std::uint64_t>() <= (std::uint64_t{1} << 53);
}

// "" or why not.
std::string ReadText(const json& value, std::string& text) {
  const std::u32string letters = DecodeUtf8(value.get_ref<const std::string&>());
  if (letters.find_first_not_of(U' ') == std::u32string::npos) return "text: it is empty";
  if (letters.size() > kLongestMark) {
    return "text: " + std::to_string(letters.size()) + " characters are more than " +
           std::to_string(kLongestMark);
  }
  text = EncodeUtf8(letters);
  return "";
}

}  // namespace

tl::expected<MarkOrder, std::string> ParseMarkOrder(std::string_view body) {
  const json order = ParseJson(body);
  if (!order.is_object()) return tl::unexpected(std::string(kExpectedMark));
  MarkOrder parsed;
  bool removes = false;
  for (const auto& [key, value] : order.items()) {
    std::string wrong;
    if (key == "id" && IsCount(value)) {
      parsed.id = value.get<std::uint64_t>();
    } else if (key == "state" && IsCount(value)) {
      parsed.state = value.get<std::uint64_t>();
    } else if (key == "button" && IsCount(value) && value >= 1 && value <= 9) {
      parsed.button = value.get<int>();
    } else if (key == "text" && value.is_string()) {
      wrong = ReadText(value, parsed.text);
    } else if (key == "is_span" && value.is_boolean()) {
      parsed.is_span = value.get<bool>();
    } else if (key == "remove" && value == true) {
      removes = true;
    } else {
      wrong = Quote(key) + ": unknown member or invalid value; " + kExpectedMark;
    }
    if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  }
  const bool names = parsed.button != 0 || !parsed.text.empty();
  const bool is_new =
      !parsed.id && parsed.state && !removes && (parsed.button != 0) != !parsed.text.empty();
  const bool changes =
      parsed.id && !names && !parsed.is_span && parsed.state.has_value() != removes;
  if (!is_new && !changes) return tl::unexpected(std::string(kExpectedMark));
  return parsed;
}

}  // namespace kinescope::http
