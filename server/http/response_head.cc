#include "server/http/response_head.h"

#include <algorithm>
#include <boost/beast/core/string.hpp>
#include <boost/beast/http/status.hpp>
#include <string_view>
#include <utility>
#include <vector>

namespace kinescope::http {
namespace {

namespace beast = boost::beast;

// The hash is that of the import map in web/index.html, the page's only inline script;
// tests/browser/unit/page_policy.test.mjs checks that they match.
constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self' 'sha256-E6EF4F1d0+NeY75jeKyUVt8uDavrRTp6S7qv8k9BjNI='; "
    "style-src 'self'; "
    "img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

class Headers {
 public:
  // In place of one of the same name.
  void Set(std::string_view name, std::string_view value) {
    const auto is_same = [name](const Line& line) {
      return beast::iequals({line.first.data(), line.first.size()}, {name.data(), name.size()});
    };
    const auto found = std::find_if(lines_.begin(), lines_.end(), is_same);
    if (found == lines_.end()) {
      lines_.emplace_back(name, value);
    } else {
      found->second = value;
    }
  }

  void AppendTo(std::string& text) const {
    for (const auto& [name, value] : lines_) {
      text.append(name).append(": ").append(value).append("\r\n");
    }
  }

 private:
  using Line = std::pair<std::string_view, std::string_view>;
  std::vector<Line> lines_;
};

}  // namespace

std::string ResponseHead(const Answer& answer, const ResponseFraming& framing) {
  const std::string length = framing.content_length ? std::to_string(*framing.content_length) : "";
  Headers headers;
  headers.Set("Server", "kinescope");
  if (answer.status != 304) headers.Set("Content-Type", answer.content_type);
  headers.Set("Content-Security-Policy", kContentSecurityPolicy);
  headers.Set("X-Content-Type-Options", "nosniff");
  headers.Set("Referrer-Policy", "no-referrer");  // the URL may contain the token
  headers.Set("Cross-Origin-Resource-Policy", "same-origin");
  for (const auto& [name, value] : answer.headers) headers.Set(name, value);
  if (framing.content_length) headers.Set("Content-Length", length);
  const bool is_old = framing.version < 11;
  if (is_old && framing.keep_alive) headers.Set("Connection", "keep-alive");
  if (!is_old && !framing.keep_alive) headers.Set("Connection", "close");

  const auto reason = beast::http::obsolete_reason(
      beast::http::int_to_status(static_cast<unsigned>(answer.status)));
  std::string head = is_old ? "HTTP/1.0 " : "HTTP/1.1 ";
  head.append(std::to_string(answer.status)).append(" ");
  head.append(reason.data(), reason.size()).append("\r\n");
  headers.AppendTo(head);
  return head.append("\r\n");
}

}  // namespace kinescope::http
