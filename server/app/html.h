/// Encodes texts and pictures for HTML. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope::app {

/// For element content and quoted attributes; invalid UTF-8 becomes U+FFFD.
std::string EscapeHtml(std::string_view text);

/// A path as a part of an address (RFC 3986, 3.3): bytes that are not plain as %XX.
std::string PercentEncoded(std::string_view path);

/// "data:image/png;base64,...": an embedded picture.
std::string DataUrl(std::string_view media_type, std::string_view bytes);

}  // namespace kinescope::app
