/// Reads a text file line by line, with a limit for each: of lists of jobs and of results. One
/// thread.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "core/system/input_file.h"

namespace kinescope::app {

class JsonLines {
 public:
  struct Line {
    int number = 0;            // from 1
    std::string text;          // without the line break
    bool is_too_long = false;  // `text` is then empty
    bool is_whole = true;      // false: the file ends without a line break
  };

  /// `file` is borrowed.
  JsonLines(InputFile& file, std::size_t most_bytes) : file_(file), most_bytes_(most_bytes) {}

  /// The next line; nullopt at the end, or after a failure.
  std::optional<Line> Next();

  /// Why reading ended early; "": it did not.
  std::string failure() const;

 private:
  InputFile& file_;
  const std::size_t most_bytes_;
  int number_ = 0;
};

}  // namespace kinescope::app
