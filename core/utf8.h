/// UTF-8 that comes from elsewhere.
#pragma once

#include <string>
#include <string_view>

namespace kinescope {

/// Code points of `utf8`; what is no UTF-8 or no printable character becomes U+FFFD.
std::u32string DecodeUtf8(std::string_view utf8);

}  // namespace kinescope
