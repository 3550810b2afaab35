/// Reads the cells of a row and checks what the row says. Pure functions; any thread. A refusal is
/// a SourceError with file, line, column, value and what was expected.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/wrenches/bounded_lines.h"
#include "server/wrenches/wrench_row.h"

namespace kinescope::wrenches {

constexpr double kMostSecs = 864'000;   // ten days
constexpr double kMostForce = 1e5;      // N, and N·m
constexpr double kFarthestPoint = 1e3;  // m

/// A finite number from -`most` to `most`, with a decimal point.
double NumberIn(std::string_view cell, std::string_view column, double most,
                const BoundedLines& lines);

/// Without blanks at both ends.
std::string_view Trimmed(std::string_view text);

/// Checks sign and point. `lines` is at the line of the row.
void CheckRow(const WrenchRow& row, const BoundedLines& lines);

}  // namespace kinescope::wrenches
