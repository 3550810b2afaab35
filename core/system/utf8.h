/// Decodes untrusted UTF-8. Pure function, any thread.
#pragma once

#include <string>
#include <string_view>

namespace kinescope {

/// The code points of `utf8`; invalid bytes and characters that cannot be printed become U+FFFD.
std::u32string DecodeUtf8(std::string_view utf8);

}  // namespace kinescope
