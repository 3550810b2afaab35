#include "server/app/html.h"

#include <fmt/format.h>

#include <cstdint>

#include "core/system/utf8.h"

namespace kinescope::app {

std::string EscapeHtml(std::string_view text) {
  std::string escaped;
  for (const char32_t c : DecodeUtf8(text)) {
    const bool is_plain =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
        (c < 0x80 &&
         std::string_view(" .,:;/%()+-_=").find(static_cast<char>(c)) != std::string_view::npos);
    if (is_plain) {
      escaped += static_cast<char>(c);
    } else {
      escaped += "&#" + std::to_string(static_cast<std::uint32_t>(c)) + ';';
    }
  }
  return escaped;
}

std::string PercentEncoded(std::string_view path) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-._~/";
  std::string encoded;
  for (const char c : path) {
    const bool is_plain = kPlain.find(c) != std::string_view::npos;
    encoded += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return encoded;
}

std::string DataUrl(std::string_view media_type, std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string url = "data:" + std::string(media_type) + ";base64,";
  url.reserve(url.size() + (bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      bits = bits << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    }
    for (std::size_t i = 0; i < 4; ++i) {
      url += at + i > bytes.size() ? '=' : kDigits[bits >> (18 - 6 * i) & 63];
    }
  }
  return url;
}

}  // namespace kinescope::app
