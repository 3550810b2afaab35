/// A log that does not repeat itself with every picture.
#pragma once

#include <set>
#include <string>

#include "render/renderer.h"

namespace kinescope::render {

/// Says each thing once, however often it comes up.
class OnceLog {
 public:
  explicit OnceLog(const LogLine& log) : log_(log) {}
  void operator()(const std::string& line) {
    if (said_.size() >= kMostLines) said_.clear();  // names come from outside, without end
    if (said_.insert(line).second) log_(line);
  }

 private:
  static constexpr std::size_t kMostLines = 1000;
  const LogLine& log_;
  std::set<std::string> said_;
};

}  // namespace kinescope::render
