/// The path under which a proxy offers the page: "/lab3" if its address is
/// https://example.org/lab3/. Pure functions, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace kinescope::http {

inline constexpr std::size_t kMaxBasePathBytes = 200;

/// `text` without a "/" at its end; "" is no base path. @throws UsageError unless it begins with
/// "/" and its segments are of letters, digits and "-._~", none of them "." or "..".
[[nodiscard]] std::string CheckedBasePath(const std::string& text);

/// The target of a request line as the routes know it: "/lab3/app.js" is "/app.js". One without the
/// base path stays as it is, because many proxies remove it. nullopt: it is the base path itself,
/// without the "/" that relative addresses need.
[[nodiscard]] std::optional<std::string> WithoutBasePath(std::string_view target,
                                                         const std::string& base_path);

}  // namespace kinescope::http
