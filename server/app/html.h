/// Encodes texts and pictures for HTML. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope::app {

/// For element content and quoted attributes; invalid UTF-8 becomes U+FFFD.
std::string EscapeHtml(std::string_view text);

/// "data:image/png;base64,...": an embedded picture.
std::string DataUrl(std::string_view media_type, std::string_view bytes);

}  // namespace kinescope::app
