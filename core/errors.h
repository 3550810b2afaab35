/// Failures that end a command (style: "cannot start or go on"). what() is one line that names the
/// value, the place and the way out; main() prints it and exits with code 2.
#pragma once

#include <stdexcept>

namespace kinescope {

class UsageError : public std::runtime_error {  // an option or an argument is wrong
 public:
  using std::runtime_error::runtime_error;
};

class SourceError : public std::runtime_error {  // a source cannot be opened or is not what it says
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kinescope
