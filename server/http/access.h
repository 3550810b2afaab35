/// Who may ask at all: the token, and which web pages may open our WebSocket. Pure functions, any
/// thread.
#pragma once

#include <string>
#include <string_view>

#include "server/http/target.h"

namespace kinescope::http {

enum class Access {
  kDenied,
  kByCookie,
  kByQuery,  // the answer should set the cookie, so that the page's own requests get in
  kOpen,     // no token is required
};

/// `cookies`: the Cookie header. The comparison takes as long for a near miss as for a wild guess.
[[nodiscard]] Access CheckToken(const std::string& token, const std::string& cookie_name,
                                const Target& target, std::string_view cookies);

/// Whether `token` can be a cookie's value as it is: letters, digits and -._~ only.
[[nodiscard]] bool FitsIntoCookie(std::string_view token);

/// Whether a page of `origin` (Origin header) was served by `host` (Host header). True without an
/// origin: then it is no web page that asks.
[[nodiscard]] bool IsSameOrigin(std::string_view origin, std::string_view host);

/// Whether the Host header names this machine: "localhost", 127.x.x.x or [::1], with or without a
/// port. Without a token this is what keeps a foreign site out that resolves its own name to
/// 127.0.0.1 (DNS rebinding).
[[nodiscard]] bool NamesThisMachine(std::string_view host);

}  // namespace kinescope::http
