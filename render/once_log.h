/// A log that does not repeat a line with every picture. One thread.
#pragma once

#include <set>
#include <string>

#include "render/renderer.h"

namespace kinescope::render {

/// Logs each line once, however often it is reported.
class OnceLog {
 public:
  explicit OnceLog(const LogLine& log) : log_(log) {}
  void operator()(const std::string& line) {
    if (said_.size() >= kMaxLines) said_.clear();  // limits memory: names are untrusted
    if (said_.insert(line).second) log_(line);
  }

 private:
  static constexpr std::size_t kMaxLines = 1000;
  const LogLine& log_;
  std::set<std::string> said_;
};

}  // namespace kinescope::render
