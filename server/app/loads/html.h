/// Text and pictures into HTML. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope::app {

/// For element content and quoted attributes; what is no UTF-8 becomes U+FFFD.
std::string EscapeHtml(std::string_view text);

/// "data:image/png;base64,...": a picture inside the page.
std::string DataUrl(std::string_view media_type, std::string_view bytes);

}  // namespace kinescope::app
