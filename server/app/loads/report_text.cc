#include "server/app/loads/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "core/scene_state.h"
#include "core/system/utf8.h"
#include "server/table/load_rows.h"

namespace kinescope::app {
namespace {

constexpr double kMmPerPoint = 25.4 / 72;

// Advance widths of Helvetica, thousandths of the font size, from space to tilde.
constexpr std::array<int, 95> kAdvances = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};

double AdvanceOf(char32_t c) {
  constexpr int kLatin = 667, kWide = 1000;  // at most, of accented letters; of all others
  constexpr char32_t kFirst = 0x20, kLastLatin = 0x24F;
  if (c >= kFirst && c - kFirst < kAdvances.size()) return kAdvances[c - kFirst];
  return c <= kLastLatin ? kLatin : kWide;
}

double WidthOf(const std::u32string& text, double size_pt) {
  double thousandths = 0;
  for (const char32_t c : text) thousandths += AdvanceOf(c);
  return thousandths / 1000 * size_pt * kMmPerPoint;
}

constexpr std::size_t kTrunkJoints = 3;  // before the pairs, in kScoredJoints

}  // namespace

std::string NumberOrDash(double value, int decimals) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, decimals) : "–";
}

std::string PercentText(std::uint64_t part, std::uint64_t all) {
  if (part == 0 || all == 0) return "0";
  if (part >= all) return "100";
  const double percent = 100 * static_cast<double>(part) / static_cast<double>(all);
  if (percent < 0.05) return "<0.1";
  if (percent >= 99.95) return ">99.9";
  return fmt::format("{:.1f}", percent);
}

std::string JointWord(std::size_t index) {
  std::string word(ScoredLabel(index));
  const bool is_name = word.size() > 1 && std::isdigit(static_cast<unsigned char>(word[1])) != 0;
  if (!is_name) word[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(word[0])));
  return word;
}

std::string JointWords(const std::vector<std::size_t>& indices) {
  std::string words;
  const auto add = [&](const std::string& word) { words += (words.empty() ? "" : ", ") + word; };
  const auto has = [&](std::size_t index) {
    return std::find(indices.begin(), indices.end(), index) != indices.end();
  };
  for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
    const bool is_right = i >= kTrunkJoints && (i - kTrunkJoints) % 2 == 0;
    if (is_right && has(i) && has(i + 1)) {
      const std::string side = "right ";
      add("both " + JointWord(i).substr(side.size()) + "s");
      ++i;
    } else if (has(i)) {
      add(JointWord(i));
    }
  }
  return words;
}

double TextWidthMm(std::string_view text, double size_pt) {
  return WidthOf(DecodeUtf8(text), size_pt);
}

std::string Shortened(std::string_view text, double size_pt, double width_mm) {
  std::u32string characters = DecodeUtf8(text);
  if (WidthOf(characters, size_pt) <= width_mm) return EncodeUtf8(characters);
  constexpr char32_t kEllipsis = 0x2026;
  while (!characters.empty() && WidthOf(characters + kEllipsis, size_pt) > width_mm) {
    characters.pop_back();
  }
  while (!characters.empty() && characters.back() == U' ') characters.pop_back();
  return EncodeUtf8(characters + kEllipsis);
}

}  // namespace kinescope::app
