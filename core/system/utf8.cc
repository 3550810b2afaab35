#include "core/system/utf8.h"

#include <algorithm>
#include <cstddef>

namespace kinescope {
namespace {

// C0, DEL and C1.
bool IsControl(char32_t c) { return c < 0x20 || (c >= 0x7F && c < 0xA0); }

// Characters that change the direction of writing: a reader sees another text than the bytes say.
bool IsReversing(char32_t c) {
  return (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
}

}  // namespace

std::u32string DecodeUtf8(std::string_view utf8) {
  constexpr char32_t kReplacement = 0xFFFD;
  std::u32string decoded;
  for (std::size_t at = 0; at < utf8.size();) {
    const auto lead = static_cast<unsigned char>(utf8[at++]);
    const int more = lead < 0x80   ? 0
                     : lead < 0xC2 ? -1
                     : lead < 0xE0 ? 1
                     : lead < 0xF0 ? 2
                     : lead < 0xF5 ? 3
                                   : -1;
    if (more < 0) {
      decoded += kReplacement;
      continue;
    }
    char32_t value = more == 0 ? lead : lead & (0x3F >> more);
    int taken = 0;
    while (taken < more && at < utf8.size() &&
           (static_cast<unsigned char>(utf8[at]) & 0xC0) == 0x80) {
      value = (value << 6) | (static_cast<unsigned char>(utf8[at++]) & 0x3F);
      ++taken;
    }
    const bool is_overlong = (more == 2 && value < 0x800) || (more == 3 && value < 0x10000);
    const bool is_surrogate = value >= 0xD800 && value < 0xE000;
    const bool is_good = taken == more && !is_overlong && !is_surrogate && value < 0x110000 &&
                         !IsControl(value) && !IsReversing(value);
    decoded += is_good ? value : kReplacement;
  }
  return decoded;
}

std::string EncodeUtf8(std::u32string_view code_points) {
  std::string utf8;
  const auto put = [&](char32_t bits) { utf8 += static_cast<char>(bits); };
  for (const char32_t c : code_points) {
    if (c < 0x80) {
      put(c);
    } else if (c < 0x800) {
      put(0xC0 | (c >> 6));
      put(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
      put(0xE0 | (c >> 12));
      put(0x80 | ((c >> 6) & 0x3F));
      put(0x80 | (c & 0x3F));
    } else {
      put(0xF0 | (c >> 18));
      put(0x80 | ((c >> 12) & 0x3F));
      put(0x80 | ((c >> 6) & 0x3F));
      put(0x80 | (c & 0x3F));
    }
  }
  return utf8;
}

std::string PrintableLine(std::string_view text) { return EncodeUtf8(DecodeUtf8(text)); }

std::string PrintableLines(std::string_view text) {
  std::string lines;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of("\n\t", at), text.size());
    lines += PrintableLine(text.substr(at, end - at));
    if (end < text.size()) lines += text[end];
    at = end + 1;
  }
  return lines;
}

}  // namespace kinescope
