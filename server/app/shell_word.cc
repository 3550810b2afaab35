#include "server/app/shell_word.h"

#include <string_view>

namespace kinescope::app {

std::string ShellWord(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.,:/@%+=-";
  constexpr std::string_view kNotFirst = "-=";  // zsh reads = at the beginning
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos &&
      kNotFirst.find(text.front()) == std::string_view::npos) {
    return text;
  }
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

}  // namespace kinescope::app
