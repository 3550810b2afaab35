/// A file that appears under its name only when it is whole, and leaves nothing behind otherwise.
/// Where the file system can (O_TMPFILE) it has no name until then, so even SIGKILL leaves nothing;
/// elsewhere it is a hidden file beside the target, removed by the destructor. One thread at a
/// time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace kinescope::render {

class NewFile {
 public:
  /// @throws std::runtime_error naming `target` and why its folder takes no file, or that what has
  /// this name now is a folder, a device or a pipe.
  explicit NewFile(std::filesystem::path target);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// @throws std::runtime_error naming the target and the reason (disk full, ...).
  void Write(const void* data, std::size_t size);

  /// A path that libraries can open for writing and reading while the file is not yet finished.
  std::string open_path() const;

  /// Puts the file in place; replaces what is there. @throws std::runtime_error as above.
  void Commit();

 private:
  [[noreturn]] void Fail(const std::string& what) const;

  std::filesystem::path target_;
  std::filesystem::path hidden_;  // "" while the file has no name
  int descriptor_ = -1;
};

/// All of a file at once. @throws std::runtime_error naming `path` and the reason.
void WriteNewFile(const std::filesystem::path& path, std::string_view content);

}  // namespace kinescope::render
