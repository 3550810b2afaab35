/// Parses the grammar of option values: lists and numbers. Pure functions, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace kinescope::options {

/// The items of a list, without surrounding blanks. A semicolon separates items; so does a comma,
/// unless it is in parentheses or a number follows it: "head:1.5,t8:8@-0.15,0,0.1" has two items.
/// "" has none.
std::vector<std::string> SplitItems(std::string_view text);

/// The texts before and after the last `separator`; nullopt if there is none.
std::optional<std::pair<std::string, std::string>> SplitAtLast(std::string_view text,
                                                               char separator);

/// A finite number and nothing else ("1e3", "-.5", "+2"); the decimal separator is a point in every
/// locale.
std::optional<double> ParseNumber(std::string_view text);

/// A whole number and nothing else.
std::optional<long> ParseWhole(std::string_view text);

/// "1,2.5,-3". nullopt if a part is not a number or is missing.
std::optional<std::vector<double>> ParseNumbers(std::string_view text);

/// The shortest text that ParseNumber() reads as the same number, bit by bit.
std::string NumberText(double number);

}  // namespace kinescope::options
