/// What readers of URDFs throw.
#pragma once

#include <stdexcept>
#include <string>

namespace kinescope::urdf {

/// The text is no usable URDF; what() says which element is wrong and why, after its line where
/// that is known.
class UrdfError : public std::runtime_error {
 public:
  explicit UrdfError(const std::string& what, int line = 0)
      : std::runtime_error(line > 0 ? "line " + std::to_string(line) + ": " + what : what),
        line_(line) {}
  /// From 1; 0 where it is not known.
  int line() const { return line_; }

 private:
  int line_;
};

}  // namespace kinescope::urdf
