#include "core/system/install_paths.h"

#include <system_error>
#include <vector>

namespace kinescope {
namespace {

namespace fs = std::filesystem;

fs::path ExecutableFolder() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored).parent_path();
}

fs::path FirstThatExists(const std::vector<fs::path>& candidates) {
  for (const fs::path& candidate : candidates) {
    std::error_code ignored;
    if (fs::exists(candidate, ignored)) return fs::weakly_canonical(candidate, ignored);
  }
  return {};
}

}  // namespace

fs::path FindModule(const std::string& file_name) {
  const fs::path here = ExecutableFolder();
  return FirstThatExists({here / file_name, here / "../lib/kinescope" / file_name,
                          here / "../../lib/kinescope" / file_name,
                          fs::path(KINESCOPE_BUILD_DIR) / "lib/kinescope" / file_name});
}

fs::path FindProgram() {
  return FirstThatExists({ExecutableFolder() / "../libexec/kinescope/kinescope",
                          fs::path(KINESCOPE_BUILD_DIR) / "libexec/kinescope/kinescope"});
}

fs::path FindResource(const std::string& name) {
  const fs::path here = ExecutableFolder();
  return FirstThatExists({here / "../share/kinescope" / name, here / "../../share/kinescope" / name,
                          fs::path(KINESCOPE_SOURCE_DIR) / name});
}

}  // namespace kinescope
