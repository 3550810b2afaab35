/// The file of marks: JSON Lines, to which each change of a mark is one line more; the last line of
/// an id holds. A line is written in one piece, so it survives when the program is killed. One
/// thread.
#pragma once

#include <filesystem>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "server/marks/mark.h"

namespace kinescope::marks {

/// The lines of a file that no server need have open. @return or why not, with the path
tl::expected<std::vector<Mark>, std::string> ReadMarks(const std::filesystem::path& path);

class MarkFile {
 public:
  /// Opens `path`, or makes it and the folders above it, and reads what it holds: `marks` in the
  /// order of their lines. @return null, or why not, with the way out
  static tl::expected<MarkFile, std::string> Open(const std::filesystem::path& path,
                                                  std::vector<Mark>& marks);
  MarkFile(MarkFile&& other) noexcept;
  MarkFile& operator=(MarkFile&&) = delete;
  ~MarkFile();

  /// Adds a line. If that fails, the file is as before. @return "", or why it failed
  [[nodiscard]] std::string Append(const Mark& mark);

  int unread_lines() const { return unread_lines_; }  // that are no marks; they stay

  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;  // of a file that is read

 private:
  MarkFile(int descriptor, std::filesystem::path path)
      : descriptor_(descriptor), path_(std::move(path)) {}
  std::string Read(std::vector<Mark>& marks);
  std::string Write(const std::string& text);

  int descriptor_;
  std::filesystem::path path_;
  int unread_lines_ = 0;
};

}  // namespace kinescope::marks
