/// Access control: token check, and which origins may open the WebSocket. Pure functions, any
/// thread.
#pragma once

#include <string>
#include <string_view>

#include "server/http/target.h"

namespace kinescope::http {

enum class Access {
  kDenied,
  kByCookie,
  kByQuery,  // the answer should set the cookie, so that later requests of the page are accepted
  kOpen,     // no token is required
};

/// `cookies`: the Cookie header. The comparison takes the same time for every wrong token.
[[nodiscard]] Access CheckToken(const std::string& token, const std::string& cookie_name,
                                const Target& target, std::string_view cookies);

/// Whether `token` can be used as the value of a cookie: letters, digits and -._~ only.
[[nodiscard]] bool FitsIntoCookie(std::string_view token);

/// Whether a page of `origin` (Origin header) was served by `host` (Host header). True without an
/// origin: then the client is not a web page.
[[nodiscard]] bool IsSameOrigin(std::string_view origin, std::string_view host);

/// Whether the Host header names this machine: "localhost", 127.x.x.x or [::1], with or without a
/// port. Without a token, this check rejects a foreign site that resolves its own name to 127.0.0.1
/// (DNS rebinding).
[[nodiscard]] bool NamesThisMachine(std::string_view host);

}  // namespace kinescope::http
