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
  const fs::path here = ExecutableFolder(), modules = "lib/kinescope";
  fs::path beside = FirstThatExists({here / file_name});
  if (!beside.empty()) return beside;
  // The first folder decides: half an installation does not load the modules of another one.
  const fs::path folder = FirstThatExists(
      {here / ".." / modules, here / "../.." / modules, fs::path(KINESCOPE_BUILD_DIR) / modules});
  return folder.empty() ? fs::path() : FirstThatExists({folder / file_name});
}

fs::path FindProgram(const std::string& name) {
  const fs::path here = ExecutableFolder(), programs = "libexec/kinescope";
  // The first folder decides, as above.
  const fs::path folder = FirstThatExists({here / ".." / programs, here / "../.." / programs,
                                           fs::path(KINESCOPE_BUILD_DIR) / programs});
  return folder.empty() ? fs::path() : FirstThatExists({folder / name});
}

fs::path FindWebBundle() {
  const fs::path here = ExecutableFolder(), bundle = "share/kinescope/web/bundle/app.js";
  return FirstThatExists({here / ".." / bundle, here / "../.." / bundle,
                          fs::path(KINESCOPE_BUILD_DIR) / "web/app.js"});
}

fs::path FindBuildFolder() { return FirstThatExists({KINESCOPE_BUILD_DIR}); }

fs::path FindResource(const std::string& name) {
  const fs::path here = ExecutableFolder();
  return FirstThatExists({here / "../share/kinescope" / name, here / "../../share/kinescope" / name,
                          fs::path(KINESCOPE_SOURCE_DIR) / name});
}

}  // namespace kinescope
