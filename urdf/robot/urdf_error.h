/// The exception that all URDF readers throw.
#pragma once

#include <stdexcept>
#include <string>

namespace kinescope::urdf {

/// Invalid URDF. what() contains the line, if known, the element and the reason.
class UrdfError : public std::runtime_error {
 public:
  explicit UrdfError(const std::string& what, int line = 0)
      : std::runtime_error(line > 0 ? "line " + std::to_string(line) + ": " + what : what),
        line_(line) {}
  /// From 1; 0 if unknown.
  int line() const { return line_; }

 private:
  int line_;
};

}  // namespace kinescope::urdf
