#include "server/http/series_json.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "core/system/words.h"

namespace kinescope::http {
namespace {

using history::SeriesColumn;
using history::SeriesKey;
using history::SeriesKeys;

constexpr std::int64_t kLatestMicros = 9'000'000'000'000'000;  // in ns it fits, too

using Error = tl::unexpected<std::string>;

std::string Quoted(const std::string& name, const std::string& value) {
  constexpr std::size_t kLongestQuote = 60;
  return name + "=" +
         (value.size() > kLongestQuote ? value.substr(0, kLongestQuote) + "..." : value) + ": ";
}

tl::expected<std::int64_t, std::string> WholeNumber(const std::map<std::string, std::string>& query,
                                                    const std::string& name, std::int64_t least,
                                                    std::int64_t most) {
  const auto found = query.find(name);
  const std::string range = std::to_string(least) + " to " + std::to_string(most);
  if (found == query.end()) return Error("set " + name + "=, a whole number from " + range);
  const std::string& text = found->second;
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < least || value > most) {
    return Error(Quoted(name, text) + "expected a whole number from " + range);
  }
  return value;
}

tl::expected<std::vector<std::size_t>, std::string> Keys(
    const std::map<std::string, std::string>& query) {
  const auto found = query.find("keys");
  if (found == query.end()) return Error("set keys=, such as keys=l5_s1,compression");
  const std::string& text = found->second;
  const auto count = static_cast<std::size_t>(std::count(text.begin(), text.end(), ',')) + 1;
  if (count > kMostSeriesKeys) {
    return Error("keys=: " + std::to_string(count) + " keys; expected 1 to " +
                 std::to_string(kMostSeriesKeys));
  }
  std::vector<std::size_t> keys;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::string_view name = rest.substr(0, comma);
    const auto key = history::FindSeriesKey(name);
    if (!key) {
      std::vector<std::string> names;
      for (const SeriesKey& each : SeriesKeys()) names.emplace_back(each.name);
      return Error(Quoted("keys", std::string(name)) + "unknown key; expected " +
                   Alternatives(names));
    }
    keys.push_back(*key);
    if (comma == std::string_view::npos) return keys;
    rest.remove_prefix(comma + 1);
  }
}

template <class Number>
void PutNumber(Number value, std::string& out) {
  char digits[32];
  const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
  out.append(digits, error == std::errc() ? static_cast<std::size_t>(end - digits) : 0);
}

template <class Values, class Put>
void PutList(const char* name, const Values& values, std::string& out, const Put& put) {
  out += '"';
  out += name;
  out += "\":[";
  const char* separator = "";
  for (const auto& value : values) {
    out += separator;
    put(value);
    separator = ",";
  }
  out += ']';
}

void PutValues(const char* name, const std::vector<SeriesColumn>& columns,
               std::int32_t SeriesColumn::*member, double steps, std::string& out) {
  PutList(name, columns, out, [&](const SeriesColumn& column) {
    if (!column.is_known()) {
      out += "null";
    } else {
      PutNumber(column.*member / steps, out);  // shortest text: 0.3415, not 0.34150000000000003
    }
  });
}

}  // namespace

tl::expected<history::SeriesQuestion, std::string> ParseSeriesQuestion(
    const std::map<std::string, std::string>& query) {
  for (const auto& [name, value] : query) {
    constexpr std::array<std::string_view, 6> kNames = {"person", "keys",    "from",
                                                        "to",     "columns", "token"};
    if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) {
      return Error(Quoted(name, value) + "expected person, keys, from, to, columns");
    }
  }
  const auto person = WholeNumber(query, "person", 0, std::numeric_limits<std::int32_t>::max());
  if (!person) return Error(person.error());
  auto keys = Keys(query);
  if (!keys) return Error(keys.error());
  const auto from = WholeNumber(query, "from", 0, kLatestMicros);
  if (!from) return Error(from.error());
  const auto until =
      WholeNumber(query, "to", *from + 1, std::min(kLatestMicros, *from + kLongestSeriesMicros));
  if (!until) return Error(until.error());
  const auto columns = WholeNumber(query, "columns", 1, kMostSeriesColumns);
  if (!columns) return Error(columns.error());
  const auto cells = static_cast<std::size_t>(*columns) * keys->size();
  if (cells > kMostSeriesCells) {
    return Error("columns=" + std::to_string(*columns) + ": " + std::to_string(keys->size()) +
                 " keys have at most " + std::to_string(kMostSeriesCells / keys->size()) +
                 " columns");
  }
  history::SeriesQuestion question;
  question.character = static_cast<int>(*person);
  question.keys = *std::move(keys);
  question.from_nanos = 1000 * *from;
  question.until_nanos = 1000 * *until;
  question.columns = static_cast<std::size_t>(*columns);
  return question;
}

std::string SeriesJson(const history::SeriesQuestion& question,
                       const history::SeriesAnswer& answer) {
  std::string out = "{\"person\":";
  PutNumber(question.character, out);
  out += ",\"from\":";
  PutNumber(question.from_nanos / 1000, out);
  out += ",\"to\":";
  PutNumber(question.until_nanos / 1000, out);
  out += ',';
  PutList("samples", answer.samples, out, [&](std::uint32_t count) { PutNumber(count, out); });
  out += ",\"keys\":{";
  for (std::size_t i = 0; i < question.keys.size(); ++i) {
    const SeriesKey& key = SeriesKeys()[question.keys[i]];
    const auto& columns = answer.by_key[i];
    if (i > 0) out += ',';
    out += '"' + std::string(key.name) + "\":{\"unit\":\"" + std::string(key.unit) + "\",";
    PutValues("min", columns, &SeriesColumn::min, key.steps, out);
    out += ',';
    PutValues("max", columns, &SeriesColumn::max, key.steps, out);
    out += ',';
    PutValues("last", columns, &SeriesColumn::last, key.steps, out);
    out += '}';
  }
  return out + "}}\n";
}

}  // namespace kinescope::http
