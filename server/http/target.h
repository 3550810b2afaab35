/// The target of a request line, taken apart and decoded. It comes from anybody: what is not
/// clearly harmless is refused here, before any route looks at it. Pure functions, any thread.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace kinescope::http {

struct Target {
  std::string path;                          // decoded; "/" first, no "." or ".." in it
  std::map<std::string, std::string> query;  // decoded; of a name given twice, the first
};

inline constexpr std::size_t kMaxTargetBytes = 2048;

/// "/a%20b?x=1" -> {"/a b", {x: 1}}. Refused, with one line for the client: more than
/// kMaxTargetBytes, no "/" in front, a broken %-escape, a control character (NUL), a backslash, an
/// empty, "." or ".." segment, escaped or not.
[[nodiscard]] tl::expected<Target, std::string> ParseTarget(std::string_view text);

/// Replaces every %XX; an error where one is broken.
[[nodiscard]] tl::expected<std::string, std::string> PercentDecode(std::string_view text);

}  // namespace kinescope::http
