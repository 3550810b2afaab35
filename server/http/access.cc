#include "server/http/access.h"

#include <algorithm>
#include <random>

#include "core/system/starts_with.h"

namespace kinescope::http {
namespace {

bool EqualInConstantTime(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0u : 1u;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const char other = b.empty() ? '\0' : b[i % b.size()];
    difference |= static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(other);
  }
  return difference == 0;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

std::vector<std::string> FindCookies(std::string_view cookies, std::string_view name) {
  std::vector<std::string> found;
  while (!cookies.empty()) {
    const std::size_t end = cookies.find(';');
    const std::string_view pair = Trim(cookies.substr(0, end));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name) {
      found.emplace_back(pair.substr(equals + 1));
    }
    cookies.remove_prefix(end == std::string_view::npos ? cookies.size() : end + 1);
  }
  return found;
}

std::optional<std::string> FindBearer(std::string_view authorization) {
  constexpr std::string_view kScheme = "bearer ";
  if (authorization.size() < kScheme.size()) return std::nullopt;
  const std::string_view scheme = authorization.substr(0, kScheme.size());
  const bool is_bearer =
      std::equal(scheme.begin(), scheme.end(), kScheme.begin(),
                 [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
  if (!is_bearer) return std::nullopt;
  return std::string(Trim(authorization.substr(kScheme.size())));
}

// nullopt: of neither token. Both are compared, so that the time does not tell which one is near.
std::optional<Role> RoleOf(const std::string& text, const PageTokens& tokens) {
  const bool is_operator = EqualInConstantTime(text, tokens.of_operator);
  const bool is_viewer = EqualInConstantTime(text, tokens.of_viewer) && !tokens.of_viewer.empty();
  if (is_operator) return Role::kOperator;
  return is_viewer ? std::optional(Role::kViewer) : std::nullopt;
}

bool IsAlphaNumeric(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace

GivenTokens FindTokens(const Target& target, std::string_view authorization,
                       std::string_view cookies, std::string_view cookie_name) {
  GivenTokens given;
  const auto asked = target.query.find("token");
  if (asked != target.query.end()) given.query = asked->second;
  given.header = FindBearer(authorization);
  given.cookies = FindCookies(cookies, cookie_name);
  return given;
}

Admission CheckToken(const PageTokens& tokens, const GivenTokens& given) {
  if (tokens.of_operator.empty()) return {Access::kOpen, Role::kOperator};
  if (given.query) {
    if (const auto role = RoleOf(*given.query, tokens)) return {Access::kByQuery, *role};
  }
  if (given.header) {
    if (const auto role = RoleOf(*given.header, tokens)) return {Access::kByHeader, *role};
  }
  std::optional<Role> highest;
  for (const std::string& cookie : given.cookies) {
    highest = std::max(highest, RoleOf(cookie, tokens));  // nullopt is the least
  }
  return highest ? Admission{Access::kByCookie, *highest} : Admission{};
}

bool FitsIntoCookie(std::string_view token) {
  return std::all_of(token.begin(), token.end(), [](char c) {
    return IsAlphaNumeric(c) || c == '-' || c == '.' || c == '_' || c == '~';
  });
}

std::string RandomToken() {
  std::random_device random;  // the kernel's
  std::string token;
  while (token.size() < 32) token += "0123456789abcdef"[random() % 16];
  return token;
}

std::string Shortened(std::string_view token) { return std::string(token.substr(0, 4)) + "..."; }

bool IsFromAnotherSite(std::string_view sec_fetch_site) {
  return !sec_fetch_site.empty() && sec_fetch_site != "same-origin" && sec_fetch_site != "none";
}

bool IsSameOrigin(std::string_view origin, std::string_view host) {
  if (origin.empty()) return true;
  const std::size_t scheme_end = origin.find("://");
  // "null" (a sandboxed page, a file) has no scheme and is never served here.
  if (scheme_end == std::string_view::npos || host.empty()) return false;
  return origin.substr(scheme_end + 3) == host;
}

bool NamesThisMachine(std::string_view host) {
  if (StartsWith(host, "[::1]")) return host.size() == 5 || host[5] == ':';
  const std::string_view name = host.substr(0, host.find(':'));
  if (name == "localhost") return true;
  if (!StartsWith(name, "127.")) return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= '0' && c <= '9') || c == '.'; });
}

}  // namespace kinescope::http
