#include "server/wrenches/wrench_cells.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace kinescope::wrenches {

std::string_view Trimmed(std::string_view text) {
  constexpr std::string_view kBlanks = " \t";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

double NumberIn(std::string_view cell, std::string_view column, double most,
                const BoundedLines& lines) {
  std::string_view text = Trimmed(cell);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && end == text.data() + text.size();
  if (!is_number || !std::isfinite(number)) {
    lines.Refuse(
        fmt::format("column {}: {}: expected a number with a decimal point", column, Quoted(cell)));
  }
  if (std::abs(number) > most) {
    lines.Refuse(fmt::format("column {}: {}: expected -{:g} to {:g}; check the unit", column,
                             Quoted(cell), most, most));
  }
  return number;
}

void CheckRow(const WrenchRow& row, const BoundedLines& lines) {
  if (IsHand(row.body)) return;
  // Filters and vibrations leave some newtons below zero, not more.
  constexpr double kMostDown = 50;  // N
  if (row.force.z() < -kMostDown) {
    lines.Refuse(
        fmt::format("the vertical force on {} is {:g} N: expected the force on the person, which "
                    "points up; if the file has the force on the plate, add "
                    "--wrench_sign on_plate",
                    Name(row.body), row.force.z()));
  }
  if (!row.point && row.force.z() > kMinGroundForce) {
    lines.Refuse(
        fmt::format("{} has a vertical force of {:g} N and no point: expected the point "
                    "at which it acts; only a hand may omit it",
                    Name(row.body), row.force.z()));
  }
}

}  // namespace kinescope::wrenches
