#include "server/app/batch/json_lines.h"

#include <cstdio>

namespace kinescope::app {

std::optional<JsonLines::Line> JsonLines::Next() {
  Line line;
  std::FILE* const file = file_.get();
  int c = std::getc(file);
  if (c == EOF) return std::nullopt;
  line.number = ++number_;
  for (; c != EOF && c != '\n'; c = std::getc(file)) {
    if (line.is_too_long) continue;
    line.text += static_cast<char>(c);
    if (line.text.size() <= most_bytes_) continue;
    line.is_too_long = true;
    line.text.clear();
  }
  line.is_whole = c == '\n';
  return line;
}

std::string JsonLines::failure() const {
  return std::ferror(file_.get()) != 0 ? file_.failure() : "";
}

}  // namespace kinescope::app
