#include "server/options/text.h"

#include <fmt/format.h>

#include <algorithm>
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

}  // namespace kinescope::options
