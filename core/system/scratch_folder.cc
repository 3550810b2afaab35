#include "core/system/scratch_folder.h"

#include <stdlib.h>

#include <stdexcept>
#include <system_error>

namespace kinescope {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
  std::string name = fs::temp_directory_path() / "kinescope-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot create a folder in " + fs::temp_directory_path().string() +
                             "; set TMPDIR to a folder with write permission");
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace kinescope
