/// Prints results to standard output; everything that a command prints goes through here, except
/// for files that are written there (server/table/output_file.h). Names in it are untrusted:
/// control characters become U+FFFD. Any thread.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <type_traits>

#include "core/system/utf8.h"

namespace kinescope::app {

/// One or several lines. @throws std::runtime_error if standard output cannot be written.
void PrintText(std::FILE* stream, std::string_view text);

/// A text as PrintableLine(), anything else as it is.
template <class T>
auto PrintableArgument(const T& value) {
  if constexpr (std::is_convertible_v<const T&, std::string_view>) {
    return PrintableLine(value);
  } else {
    return value;
  }
}

/// As fmt::print(). A text among the arguments is a part of a line: a line break in it does not
/// begin another one.
template <class... Args>
void Print(fmt::format_string<Args...> format, Args&&... args) {
  PrintText(stdout, fmt::vformat(format, fmt::make_format_args(PrintableArgument(args)...)));
}

}  // namespace kinescope::app
