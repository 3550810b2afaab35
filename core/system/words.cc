#include "core/system/words.h"

#include <algorithm>
#include <cctype>
#include <cstddef>

namespace kinescope {
namespace {

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

std::string Counted(std::uint64_t count, std::string_view one, std::string_view many) {
  const std::string text = std::to_string(count) + " ";
  if (count != 1 && !many.empty()) return text + std::string(many);
  return text + std::string(one) + (count == 1 ? "" : "s");
}

std::string Alternatives(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " or ") + names[i];
  }
  return text;
}

std::string Lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string Nearest(std::string_view text, const std::vector<std::string>& names) {
  constexpr std::size_t kLongest = 64;  // longer texts are no slip of a finger
  if (text.empty() || text.size() > kLongest) return "";
  const std::string lower = Lower(std::string(text));
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

std::string SuggestionFor(std::string_view text, const std::vector<std::string>& names) {
  const std::string nearest = Nearest(text, names);
  return nearest.empty() ? "" : "; nearest: " + nearest;
}

}  // namespace kinescope
