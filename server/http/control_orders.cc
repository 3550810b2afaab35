#include "server/http/control_orders.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/system/json_parse.h"
#include "core/system/json_text.h"
#include "core/system/utf8.h"

namespace kinescope::http {
namespace {

using nlohmann::json;

constexpr char kExpectedRecording[] =
    "expected {\"run\": true}, also with \"label\": TEXT, or {\"run\": false}";
constexpr char kExpectedClip[] =
    "expected {\"last_secs\": NUMBER}, {\"next_secs\": NUMBER} or {\"from_micros\": NUMBER, "
    "\"to_micros\": NUMBER}, also with \"camera\": NAME; or {\"cancel\": NUMBER}";
constexpr char kExpectedPerson[] =
    "expected at least one of \"mass_kg\": NUMBER, \"sex\": \"male\" or \"female\", \"height_m\": "
    "NUMBER and \"name\": TEXT; add \"person\": NUMBER if the stream has several people";
constexpr char kExpectedLimits[] =
    "expected {\"medium\": NUMBER, \"high\": NUMBER}, ratios of capacity such as 0.3 and 0.6";
constexpr char kExpectedTrial[] =
    "expected {\"start\": true, \"person\": TEXT, \"condition\": TEXT, \"number\": 1 to 9999}, "
    "{\"stop\": true}, or {\"trial\": NAME} with \"clip\": true, \"report\": true or both";

// Reads one member: false if it is unknown or its value is of another kind. A text may add why.
using ReadMember = std::function<bool(const std::string& key, const json& value, std::string& why)>;

// "" or why not.
std::string ReadObject(std::string_view body, const char* expected, const ReadMember& read) {
  const json object = ParseJson(body);
  if (!object.is_object() || object.empty()) return expected;
  for (const auto& [key, value] : object.items()) {
    std::string why;
    if (read(key, value, why)) continue;
    if (!why.empty()) return key + ": " + why;
    constexpr std::size_t kMaxShown = 40;  // bytes
    return JsonText(json(key.substr(0, kMaxShown))) + ": unknown member or invalid value; " +
           expected;
  }
  return "";
}

bool ReadNumber(const json& value, std::optional<double>& number) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) return false;
  number = value.get<double>();
  return true;
}

template <class Integer>
bool ReadCount(const json& value, std::optional<Integer>& count) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 53;
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMost) return false;
  const auto given = value.get<std::uint64_t>();
  if (given > static_cast<std::uint64_t>(std::numeric_limits<Integer>::max())) return false;
  count = static_cast<Integer>(given);
  return true;
}

bool ReadFlag(const json& value, bool& flag) {
  if (!value.is_boolean()) return false;
  flag = value.get<bool>();
  return true;
}

// One line of text with something to see.
bool ReadLabel(const json& value, std::string& label, std::string& why) {
  if (!value.is_string()) return false;
  const std::u32string letters = DecodeUtf8(value.get_ref<const std::string&>());
  const auto first = letters.find_first_not_of(U' ');
  if (first == std::u32string::npos) {
    why = "it is empty";
    return false;
  }
  const std::u32string trimmed = letters.substr(first, letters.find_last_not_of(U' ') - first + 1);
  if (trimmed.size() > kLongestLabel) {
    why = std::to_string(trimmed.size()) + " characters are more than " +
          std::to_string(kLongestLabel);
    return false;
  }
  label = EncodeUtf8(trimmed);
  return true;
}

}  // namespace

Parsed<RecordingOrder> ParseRecordingOrder(std::string_view body) {
  RecordingOrder order;
  bool has_run = false;
  std::string wrong = ReadObject(body, kExpectedRecording,
                                 [&](const std::string& key, const json& value, std::string& why) {
                                   if (key == "run") return has_run = ReadFlag(value, order.run);
                                   return key == "label" && ReadLabel(value, order.label, why);
                                 });
  if (wrong.empty() && !has_run) wrong = kExpectedRecording;
  if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  return order;
}

Parsed<ClipOrder> ParseClipOrder(std::string_view body) {
  ClipOrder order;
  std::string wrong = ReadObject(body, kExpectedClip,
                                 [&](const std::string& key, const json& value, std::string& why) {
                                   if (key == "last_secs")
                                     return ReadNumber(value, order.last_secs);
                                   if (key == "next_secs")
                                     return ReadNumber(value, order.next_secs);
                                   if (key == "from_micros")
                                     return ReadCount(value, order.from_micros);
                                   if (key == "to_micros") return ReadCount(value, order.to_micros);
                                   if (key == "cancel") return ReadCount(value, order.cancel);
                                   return key == "camera" && ReadLabel(value, order.camera, why);
                                 });
  const bool has_span = order.from_micros || order.to_micros;
  const int given = static_cast<int>(order.last_secs.has_value()) +
                    static_cast<int>(order.next_secs.has_value()) +
                    static_cast<int>(order.cancel.has_value()) + static_cast<int>(has_span);
  const bool is_whole = order.from_micros.has_value() == order.to_micros.has_value();
  if (wrong.empty() && (given != 1 || !is_whole)) wrong = kExpectedClip;
  if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  return order;
}

Parsed<PersonOrder> ParsePersonOrder(std::string_view body) {
  PersonOrder order;
  PersonChange& change = order.change;
  std::string wrong = ReadObject(
      body, kExpectedPerson, [&](const std::string& key, const json& value, std::string& why) {
        if (key == "person") return ReadCount(value, order.person);
        if (key == "mass_kg") return ReadNumber(value, change.mass_kg);
        if (key == "height_m") return ReadNumber(value, change.height_m);
        if (key == "name") return ReadLabel(value, change.name.emplace(), why);
        if (key != "sex" || (value != "male" && value != "female")) return false;
        change.sex = value == "male" ? urdf::Sex::kMale : urdf::Sex::kFemale;
        return true;
      });
  if (wrong.empty() && change.is_empty()) wrong = kExpectedPerson;
  if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  return order;
}

Parsed<std::array<double, 2>> ParseLimitsOrder(std::string_view body) {
  std::optional<double> medium, high;
  std::string wrong = ReadObject(body, kExpectedLimits,
                                 [&](const std::string& key, const json& value, std::string&) {
                                   if (key == "medium") return ReadNumber(value, medium);
                                   return key == "high" && ReadNumber(value, high);
                                 });
  if (wrong.empty() && (!medium || !high)) wrong = kExpectedLimits;
  if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  return std::array<double, 2>{*medium, *high};
}

Parsed<TrialOrder> ParseTrialOrder(std::string_view body) {
  TrialOrder order;
  bool starts = false, stops = false;
  std::optional<int> number;
  std::string wrong = ReadObject(body, kExpectedTrial,
                                 [&](const std::string& key, const json& value, std::string& why) {
                                   if (key == "start") return ReadFlag(value, starts);
                                   if (key == "stop") return ReadFlag(value, stops);
                                   if (key == "clip") return ReadFlag(value, order.clip);
                                   if (key == "report") return ReadFlag(value, order.report);
                                   if (key == "person") return ReadLabel(value, order.person, why);
                                   if (key == "condition")
                                     return ReadLabel(value, order.condition, why);
                                   if (key == "number") return ReadCount(value, number);
                                   if (key != "trial" || !value.is_string()) return false;
                                   order.trial = value.get<std::string>();
                                   return true;
                                 });
  constexpr int kMostTrials = 9999;
  const bool makes = !order.trial.empty() && (order.clip || order.report);
  const bool names = !order.person.empty() && !order.condition.empty() && number && *number >= 1 &&
                     *number <= kMostTrials;
  const int given = static_cast<int>(starts) + static_cast<int>(stops) + static_cast<int>(makes);
  if (wrong.empty() && (given != 1 || starts != names)) wrong = kExpectedTrial;
  if (!wrong.empty()) return tl::unexpected(std::move(wrong));
  order.act = starts  ? TrialOrder::Act::kStart
              : stops ? TrialOrder::Act::kStop
                      : TrialOrder::Act::kMake;
  order.number = number.value_or(1);
  return order;
}

}  // namespace kinescope::http
