#include "core/system/utf8.h"

#include <cstddef>

namespace kinescope {

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
    const bool is_control = value < 0x20 || (value >= 0x7F && value < 0xA0);
    const bool is_surrogate = value >= 0xD800 && value < 0xE000;
    const bool is_good =
        taken == more && !is_overlong && !is_control && !is_surrogate && value < 0x110000;
    decoded += is_good ? value : kReplacement;
  }
  return decoded;
}

}  // namespace kinescope
