/// Writes a file atomically: it gets its name only when complete; otherwise nothing remains. If the
/// file system supports it (O_TMPFILE), the file has no name until then, so even SIGKILL leaves
/// nothing. Otherwise it is a hidden file in the same folder, which the destructor removes. One
/// thread at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace kinescope::render {

class NewFile {
 public:
  /// @throws std::runtime_error with `target` and why its folder accepts no file, or that `target`
  /// is a folder, a device or a pipe.
  explicit NewFile(std::filesystem::path target);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// @throws std::runtime_error with the target and the reason (disk full, ...).
  void Write(const void* data, std::size_t size);

  /// A path that libraries can open for writing and reading while the file is not finished.
  std::string open_path() const;

  /// Gives the file its name; replaces an existing file. @throws std::runtime_error as above.
  void Commit();

 private:
  [[noreturn]] void Fail(const std::string& what) const;

  std::filesystem::path target_;
  std::filesystem::path hidden_;  // "" while the file has no name
  int descriptor_ = -1;
};

/// Writes a complete file atomically. @throws std::runtime_error with `path` and the reason.
void WriteNewFile(const std::filesystem::path& path, std::string_view content);

}  // namespace kinescope::render
