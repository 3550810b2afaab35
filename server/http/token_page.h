/// The page that browsers receive in place of a route without the right token. Pure function, any
/// thread.
#pragma once

#include <string>
#include <string_view>

#include "server/http/answer.h"
#include "server/http/target.h"

namespace kinescope::http {

/// A page without scripts: it says `reason` and has a field for the token, which leads to `target`
/// again, with the rest of its query. It has a Content-Security-Policy of its own, because that of
/// the page permits no form, and it is not stored.
/// @param reason one line; it and `target` are text of any content
[[nodiscard]] Answer TokenPage(int status, const std::string& reason, const Target& target);

/// `text` as content or quoted attribute of HTML.
[[nodiscard]] std::string EscapeHtml(std::string_view text);

}  // namespace kinescope::http
