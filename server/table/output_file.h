/// A text that is written piece by piece to a new file, which gets its name only when it is
/// complete, or to standard output. One thread.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "render/image/new_file.h"

namespace kinescope::app {

class OutputFile {
 public:
  /// `path` "-": standard output. All functions @throw std::runtime_error with the path and the
  /// reason.
  explicit OutputFile(const std::string& path);

  /// Append to it, then call FlushWhenLarge().
  std::string& buffer() { return buffer_; }
  void FlushWhenLarge();
  void Finish();

 private:
  void Flush();

  std::optional<render::NewFile> file_;
  std::string buffer_;
};

/// Absolute and without links: equal for equal files, however their paths are spelt. The file need
/// not exist.
std::filesystem::path PlaceOfOutput(const std::string& path);

}  // namespace kinescope::app
