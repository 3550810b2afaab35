/// Parses and decodes the target of a request line. The input is untrusted: a target that is not
/// clearly harmless is rejected here, before any route sees it. Pure functions, any thread.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace kinescope::http {

struct Target {
  std::string path;  // decoded; starts with "/", contains no "." or ".." segment
  std::map<std::string, std::string> query;  // decoded; for a repeated name, the first value
};

inline constexpr std::size_t kMaxTargetBytes = 2048;

/// "/a%20b?x=1" -> {"/a b", {x: 1}}. Rejected, with one line for the client: more than
/// kMaxTargetBytes, no "/" at the start, an invalid %-escape, a control character (NUL), a
/// backslash, an empty, "." or ".." segment, escaped or not.
[[nodiscard]] tl::expected<Target, std::string> ParseTarget(std::string_view text);

/// Decodes every %XX; an error if one is invalid.
[[nodiscard]] tl::expected<std::string, std::string> PercentDecode(std::string_view text);

}  // namespace kinescope::http
