/// Folders for temporary files.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope {

/// The folder for temporary files: that of TMPDIR, else /tmp. Any thread.
/// @throws std::runtime_error with its name and what to do if there is no such folder.
std::filesystem::path TempFolderPath();

/// A temporary folder that is deleted with the object. One thread.
class ScratchFolder {
 public:
  /// @throws std::runtime_error with the folder for temporary files and what to do.
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace kinescope
