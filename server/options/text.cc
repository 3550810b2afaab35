#include "server/options/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>
#include <utility>

namespace kinescope::options {
namespace {

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

std::string Trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t") + 1 - begin));
}

bool BeginsWithNumber(std::string_view text) {
  std::size_t at = std::min(text.find_first_not_of(' '), text.size());
  if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
  if (at < text.size() && text[at] == '.') ++at;
  return at < text.size() && IsDigit(text[at]);
}

std::string_view WithoutPlus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return has_plus ? text.substr(1) : text;
}

template <class Number>
std::optional<Number> Parse(std::string_view text) {
  text = WithoutPlus(text);
  Number number{};
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, number);
  if (text.empty() || parsed.ec != std::errc() || parsed.ptr != end) return std::nullopt;
  return number;
}

// Damerau-Levenshtein, with exchanges of neighbours only.
std::size_t Distance(std::string_view a, std::string_view b) {
  std::vector<std::vector<std::size_t>> rows(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) rows[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t other = a[i - 1] == b[j - 1] ? 0 : 1;
      rows[i][j] = std::min({rows[i - 1][j] + 1, rows[i][j - 1] + 1, rows[i - 1][j - 1] + other});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        rows[i][j] = std::min(rows[i][j], rows[i - 2][j - 2] + 1);
      }
    }
  }
  return rows[a.size()][b.size()];
}

}  // namespace

std::vector<std::string> SplitItems(std::string_view text) {
  std::vector<std::string> items;
  if (Trimmed(text).empty()) return items;
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ';';
    depth += c == '(' ? 1 : c == ')' ? -1 : 0;
    const bool ends = i == text.size() || c == ';' ||
                      (c == ',' && depth <= 0 && !BeginsWithNumber(text.substr(i + 1)));
    if (!ends) continue;
    items.push_back(Trimmed(text.substr(begin, i - begin)));
    begin = i + 1;
  }
  return items;
}

std::optional<std::pair<std::string, std::string>> SplitAtLast(std::string_view text,
                                                               char separator) {
  const std::size_t at = text.rfind(separator);
  if (at == std::string_view::npos) return std::nullopt;
  return std::pair(std::string(text.substr(0, at)), std::string(text.substr(at + 1)));
}

std::optional<double> ParseNumber(std::string_view text) {
  const auto number = Parse<double>(text);
  return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<long> ParseWhole(std::string_view text) { return Parse<long>(text); }

std::optional<std::vector<double>> ParseNumbers(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const auto number = ParseNumber(Trimmed(text.substr(begin, end - begin)));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    begin = end + 1;
  }
  return numbers;
}

std::string NumberText(double number) { return fmt::format("{}", number); }

std::string Alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  }
  return text;
}

std::string Nearest(std::string_view text, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 64;  // longer texts are no slip of a finger
  if (text.empty() || text.size() > kLongest) return "";
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  std::string nearest;
  std::size_t least = std::max<std::size_t>(1, text.size() / 3) + 1;
  for (const std::string& name : names) {
    const std::size_t distance = Distance(lower, name);
    if (distance >= least) continue;
    least = distance;
    nearest = name;
  }
  if (!nearest.empty()) return nearest;
  // An abbreviation: the beginning of one name only, or a word within the first that has it.
  constexpr std::size_t kShortest = 3;  // of a word; shorter ones occur anywhere
  std::size_t beginnings = 0;
  std::string within;
  for (const std::string& name : names) {
    const std::size_t at = name.find(lower);
    if (at == 0 && ++beginnings == 1) nearest = name;
    if (at != std::string::npos && lower.size() >= kShortest && within.empty()) within = name;
  }
  return beginnings == 1 ? nearest : within;
}

}  // namespace kinescope::options
