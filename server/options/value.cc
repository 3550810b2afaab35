#include "server/options/value.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace kinescope::options {
namespace {

bool IsIn(const Range& range, double number) {
  return number <= range.most &&
         (range.is_least_excluded ? number > range.least : number >= range.least);
}

std::string Describe(const Range& range, const char* kind) {
  const std::string unit = range.unit.empty() ? "" : " " + range.unit;
  const std::string meaning = range.meaning.empty() ? "" : " (" + range.meaning + ")";
  const bool has_least = std::isfinite(range.least), has_most = std::isfinite(range.most);
  if (has_least && has_most && range.is_least_excluded) {
    return fmt::format("{} above {}, at most {}{}{}", kind, range.least, range.most, unit, meaning);
  }
  if (has_least && has_most) {
    return fmt::format("{} from {} to {}{}{}", kind, range.least, range.most, unit, meaning);
  }
  return kind + unit + meaning;
}

}  // namespace

void RefuseWord(const std::string& word, const std::vector<std::string>& known) {
  throw BadValue(fmt::format("unknown '{}'; expected {}", word, Alternatives(known)),
                 SuggestionFor(word, known));
}

const FormerWord* FindFormer(const std::vector<FormerWord>& words, const std::string& word) {
  const auto found = std::find_if(words.begin(), words.end(),
                                  [&](const FormerWord& each) { return each.former == word; });
  return found == words.end() ? nullptr : &*found;
}

void FilePath::SetFolder(const std::filesystem::path& folder) {
  if (!value_.empty()) value_ = (folder / value_).string();
}

std::vector<std::filesystem::path> FilePath::Files() const {
  if (value_.empty()) return {};
  return {value_};
}

void Texts::Parse(const std::string& text) {
  value_.clear();
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(';', begin), text.size());
    if (end > begin) value_.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
}

std::string Texts::ToText() const { return fmt::format("{}", fmt::join(value_, ";")); }

void Switch::Parse(const std::string& text) {
  const bool is_on = text == "on" || text == "true";
  if (!is_on && text != "off" && text != "false") RefuseText();
  value_ = is_on;
}

void Flag::Parse(const std::string& text) {
  const bool is_true = text == "true" || text == "1";
  if (!is_true && text != "false" && text != "0") RefuseText();
  value_ = is_true;
}

void Number::Parse(const std::string& text) {
  const auto number = ParseNumber(text);
  if (!number || !IsIn(range_, *number)) RefuseText();
  value_ = *number;
}

std::string Number::ToText() const { return NumberText(value_); }

std::string Number::Expected() const { return Describe(range_, "a number"); }

void Whole::Parse(const std::string& text) {
  const auto number = ParseWhole(text);
  if (!number || !IsIn(range_, static_cast<double>(*number))) RefuseText();
  value_ = *number;
}

std::string Whole::Expected() const { return Describe(range_, "a whole number"); }

void Size::Parse(const std::string& text) {
  const auto sides = SplitAtLast(text, 'x');
  const auto width = sides ? ParseWhole(sides->first) : std::nullopt;
  const auto height = sides ? ParseWhole(sides->second) : std::nullopt;
  const auto fits = [](long pixels) { return pixels >= kMin && pixels <= kMax; };
  if (!width || !height || !fits(*width) || !fits(*height)) RefuseText();
  value_ = {static_cast<int>(*width), static_cast<int>(*height)};
}

std::string Size::ToText() const { return fmt::format("{}x{}", value_.width, value_.height); }

std::string Size::Expected() const {
  return fmt::format("WIDTHxHEIGHT, each from {} to {} px, such as 1280x720", kMin, kMax);
}

}  // namespace kinescope::options
