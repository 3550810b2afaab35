#include "core/system/scratch_folder.h"

#include <stdlib.h>

#include <cstdlib>
#include <stdexcept>
#include <system_error>

namespace kinescope {

namespace fs = std::filesystem;

fs::path TempFolderPath() {
  try {
    return fs::temp_directory_path();
  } catch (const fs::filesystem_error&) {
    const char* const chosen = std::getenv("TMPDIR");
    throw std::runtime_error(chosen == nullptr
                                 ? "/tmp is not a folder; set TMPDIR to one with write permission"
                                 : "TMPDIR=" + std::string(chosen) +
                                       ": is not a folder; set it to one with write permission");
  }
}

ScratchFolder::ScratchFolder() {
  const fs::path parent = TempFolderPath();
  std::string name = parent / "kinescope-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot create a folder in " + parent.string() +
                             "; set TMPDIR to a folder with write permission");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace kinescope
