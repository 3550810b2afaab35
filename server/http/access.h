/// Access control: token check, the role that a token gives, and which origins may open the
/// WebSocket. Pure functions, any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/role.h"
#include "server/http/target.h"

namespace kinescope::http {

enum class Access {
  kDenied,
  kByCookie,
  kByQuery,   // the answer should set the cookie, so that later requests of the page are accepted
  kByHeader,  // Authorization: Bearer
  kOpen,      // no token is required
};

/// The tokens that a request contains, right or wrong.
struct GivenTokens {
  std::optional<std::string> query, header;
  /// Of our name. A page on another port of the same host can add some.
  std::vector<std::string> cookies;

  bool any() const { return query || header || !cookies.empty(); }
};

/// `authorization`, `cookies`: the headers of these names; several of them joined with "; ".
[[nodiscard]] GivenTokens FindTokens(const Target& target, std::string_view authorization,
                                     std::string_view cookies, std::string_view cookie_name);

/// The tokens of a server.
struct PageTokens {
  std::string of_operator;  // "": none is required, every client is an operator
  std::string of_viewer;    // "": there are no viewers; never without that of the operator
};

struct Admission {
  Access access = Access::kDenied;
  Role role = Role::kViewer;  // of a client that is not denied
};

/// A token in the request decides before a cookie, so that a link gives the role of its token. Of
/// several cookies the highest role counts. The comparison takes the same time for every wrong
/// token.
[[nodiscard]] Admission CheckToken(const PageTokens& tokens, const GivenTokens& given);

/// Shorter tokens can be guessed.
inline constexpr std::size_t kMinTokenLength = 16;

/// Whether `token` can be used as the value of a cookie: letters, digits and -._~ only.
[[nodiscard]] bool FitsIntoCookie(std::string_view token);

/// 128 random bits in hexadecimal digits.
[[nodiscard]] std::string RandomToken();

/// `token` as logs may show it: its first four characters and "...".
[[nodiscard]] std::string Shortened(std::string_view token);

/// Whether another site made a browser send a request with this Sec-Fetch-Site header. Browsers
/// send none to plain http:// addresses of other machines; other clients never do.
[[nodiscard]] bool IsFromAnotherSite(std::string_view sec_fetch_site);

/// Whether a page of `origin` (Origin header) was served by `host` (Host header). True without an
/// origin: then the client is not a web page.
[[nodiscard]] bool IsSameOrigin(std::string_view origin, std::string_view host);

/// Whether the Host header names this machine: "localhost", 127.x.x.x or [::1], with or without a
/// port. Without a token, this check rejects a foreign site that resolves its own name to 127.0.0.1
/// (DNS rebinding).
[[nodiscard]] bool NamesThisMachine(std::string_view host);

}  // namespace kinescope::http
