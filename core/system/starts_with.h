/// Compares the beginning of a text. Any thread.
#pragma once

#include <string_view>

namespace kinescope {

constexpr bool StartsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

}  // namespace kinescope
