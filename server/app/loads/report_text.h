/// Numbers, lists and lengths of texts for the report. Pure functions; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope::app {

/// With `decimals`; "–" if it is not finite.
std::string NumberOrDash(double value, int decimals);

/// Percent of `all` with one decimal. Zero and all are exact: "0", "<0.1", ">99.9", "100".
std::string PercentText(std::uint64_t part, std::uint64_t all);

/// The scored joint `index` within a sentence: "L5/S1", "right knee".
std::string JointWord(std::size_t index);
/// In the order of kScoredJoints, both sides together: "L5/S1, both shoulders, left ankle".
std::string JointWords(const std::vector<std::size_t>& indices);

/// Width of `text` in Arial, Helvetica or Liberation Sans, mm; of other scripts an upper bound.
double TextWidthMm(std::string_view text, double size_pt);
/// `text`, or as much of its beginning as is `width_mm` wide with a "…" after it.
std::string Shortened(std::string_view text, double size_pt, double width_mm);

}  // namespace kinescope::app
