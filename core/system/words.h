/// Words in messages: counts, alternatives, and the name that was probably meant. Pure functions,
/// any thread.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace kinescope {

/// "0 samples", "1 sample", "2 people". `many`: "" is that of one with an "s".
std::string Counted(std::uint64_t count, std::string_view one, std::string_view many = "");

/// With the letters of ASCII in lower case.
std::string Lower(std::string text);

/// "a, b or c".
std::string Alternatives(const std::vector<std::string>& names);

/// The one of `names` that `text` probably means: at most a third of its letters are different,
/// missing, added or exchanged, or it is an abbreviation. "" if there is none.
std::string Nearest(std::string_view text, const std::vector<std::string>& names);

/// The end of an error: "; nearest: left", or "" if there is no Nearest().
std::string SuggestionFor(std::string_view text, const std::vector<std::string>& names);

}  // namespace kinescope
