#pragma once

#include <algorithm>
#include <string>

namespace kinescope::app {

/// Whether links, joints and TF frames may have it in their names: letters, digits and _.
inline bool IsModelName(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  });
}

}  // namespace kinescope::app
