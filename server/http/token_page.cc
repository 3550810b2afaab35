#include "server/http/token_page.h"

#include <string_view>
#include <utility>

#include "server/http/access.h"

namespace kinescope::http {
namespace {

// As the page looks (web/style.css), which is not served without a token.
constexpr char kStyle[] = R"(
:root { color-scheme: light dark; --page: #f3f5f8; --panel: #fff; --ink: #16202e; --line: #8492a6; --accent: #1d4fb0; }
@media (prefers-color-scheme: dark) {
  :root { --page: #10151d; --panel: #1a212c; --ink: #e8edf4; --line: #6d7c91; --accent: #8fb4ff; }
}
body { margin: 0; background: var(--page); color: var(--ink); font: 16px/1.5 system-ui, sans-serif; }
main { max-width: 30rem; margin: 12vh auto 0; padding: 24px; background: var(--panel); border-radius: 8px; }
h1 { margin: 0 0 12px; font-size: 22px; }
[role=alert]::first-letter { text-transform: uppercase; }
label { display: block; margin: 20px 0 4px; font-weight: 600; }
form { margin: 0; }
input, button { box-sizing: border-box; min-height: 44px; padding: 8px 12px; border: 1px solid var(--line);
  border-radius: 6px; background: transparent; color: inherit; font: inherit; }
input { width: 100%; }
button { margin-top: 12px; font-weight: 600; }
:focus-visible { outline: 3px solid var(--accent); outline-offset: 2px; }
code { overflow-wrap: anywhere; }
)";

// The address that the form leads to: percent-encoded where the decoded path needs it.
std::string Encoded(std::string_view path) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  constexpr std::string_view kPlain = "/-._~";
  std::string text;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') ||
                          (c >= 'A' && c <= 'Z') || kPlain.find(c) != std::string_view::npos;
    if (is_plain) {
      text += c;
    } else {
      text += {'%', kDigits[byte >> 4u], kDigits[byte & 15u]};
    }
  }
  return text;
}

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&': escaped += "&amp;"; break;
      case '<': escaped += "&lt;"; break;
      case '>': escaped += "&gt;"; break;
      case '"': escaped += "&quot;"; break;
      case '\'': escaped += "&#39;"; break;
      default: escaped += c;
    }
  }
  return escaped;
}

Answer TokenPage(int status, const std::string& reason, const Target& target) {
  const std::string nonce = RandomToken();
  std::string fields;
  for (const auto& [name, value] : target.query) {
    if (name == "token") continue;
    fields += "<input type=\"hidden\" name=\"" + EscapeHtml(name) + "\" value=\"" +
              EscapeHtml(value) + "\">";
  }
  Answer answer;
  answer.status = status;
  answer.content_type = "text/html; charset=utf-8";
  answer.headers.emplace_back("Cache-Control", "no-store");
  answer.headers.emplace_back("Content-Security-Policy",
                              "default-src 'none'; style-src 'nonce-" + nonce +
                                  "'; form-action 'self'; base-uri 'none'; frame-ancestors 'none'");
  answer.body = R"(<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Token needed · Kinescope</title>
<style nonce=")" +
                nonce + "\">" + kStyle + R"(</style>
</head>
<body>
<main>
<h1>This page needs a token</h1>
<p role="alert">)" +
                EscapeHtml(reason) +
                R"(</p>
<p>The operator's token permits everything. The viewers' token, if this server has one, permits to look.
The server prints the address of the page when it starts, with the token or with the command that shows it.</p>
<form method="get" action=")" +
                EscapeHtml(Encoded(target.path)) + "\">" + fields + R"(
<label for="token">Token</label>
<input id="token" name="token" type="password" required autofocus autocomplete="current-password" spellcheck="false">
<button type="submit">Open the page</button>
</form>
</main>
</body>
</html>
)";
  return answer;
}

}  // namespace kinescope::http
