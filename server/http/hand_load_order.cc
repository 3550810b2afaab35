#include "server/http/hand_load_order.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"

namespace kinescope::http {

using nlohmann::json;

namespace {

bool IsNumber(const json& value) { return value.is_number() && std::isfinite(value.get<double>()); }

bool IsPoint(const json& value) {
  return value.is_array() && value.size() == 3 && IsNumber(value[0]) && IsNumber(value[1]) &&
         IsNumber(value[2]);
}

}  // namespace

tl::expected<HandLoadOrder, std::string> ParseHandLoadOrder(std::string_view body) {
  const std::string expected =
      "expected a JSON object such as {\"right_kg\": 5, \"left_kg\": 0, \"both_kg\": 0}; add "
      "\"person\": NUMBER if the stream has several persons, and \"right_com_m\" or "
      "\"left_com_m\": [x, y, z] if the load is not at the grip";
  const json order = ParseJson(body);
  if (!order.is_object() || order.empty()) return tl::unexpected(expected);
  HandLoadOrder parsed;
  parsed.load.is_known = true;
  for (const auto& [key, value] : order.items()) {
    double* const mass = key == "right_kg"  ? &parsed.load.mass_kg[urdf::kRight]
                         : key == "left_kg" ? &parsed.load.mass_kg[urdf::kLeft]
                         : key == "both_kg" ? &parsed.load.both_kg
                                            : nullptr;
    if (mass != nullptr && IsNumber(value)) {
      *mass = value.get<double>();
    } else if ((key == "right_com_m" || key == "left_com_m") && IsPoint(value)) {
      const urdf::Side side = key == "right_com_m" ? urdf::kRight : urdf::kLeft;
      parsed.load.com_in_hand[side].emplace(value[0], value[1], value[2]);
    } else if (key == "person" && value.is_number_integer() && value.get<std::int64_t>() >= 0 &&
               value.get<std::int64_t>() <= std::numeric_limits<std::int32_t>::max()) {
      parsed.person = value.get<int>();
    } else {
      constexpr std::size_t kMaxShown = 40;  // bytes
      return tl::unexpected(JsonText(json(key.substr(0, kMaxShown)), -1, JsonBytes::kAscii) +
                            ": unknown member or invalid value; " + expected);
    }
  }
  return parsed;
}

}  // namespace kinescope::http
