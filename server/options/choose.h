/// Option texts as values, refused with the option's name, the text and what was expected.
#pragma once

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "core/errors.h"

namespace kinescope::app {

template <class Value>
using Choices = std::vector<std::pair<const char*, Value>>;

/// The value that goes with `given`. @throws UsageError.
template <class Value>
Value Choose(const char* name, const std::string& given, const Choices<Value>& choices) {
  std::string known;
  for (const auto& [text, value] : choices) {
    if (given == text) return value;
    known += (known.empty() ? "" : ", ") + std::string(text);
  }
  throw UsageError(fmt::format("--{}={}: expected one of {}", name, given, known));
}

/// "head:1.5,t8:8@-0.15,0,0.1": at semicolons, and at commas that no number follows.
std::vector<std::string> SplitList(const std::string& text);

/// @throws UsageError.
bool ToSwitch(const std::string& name, const std::string& on_or_off);

/// Width and height, px, each 16 to 8192. @throws UsageError.
std::pair<int, int> ToSize(const std::string& name, const std::string& width_x_height);

}  // namespace kinescope::app
