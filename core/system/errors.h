/// Exceptions that end a command (style: "cannot start or go on"). what() is one line with the
/// value, its place and the remedy; main() prints it and exits with code 2.
#pragma once

#include <stdexcept>

namespace kinescope {

class UsageError : public std::runtime_error {  // invalid option or argument
 public:
  using std::runtime_error::runtime_error;
};

class SourceError : public std::runtime_error {  // a source that cannot be opened or has the wrong
                                                 // format
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace kinescope
