// The only source of the tests with a path of this computer in it: the others are compiled to the
// same objects in each clone, so that ccache has them.
#include "tests/folders.h"

#include <cstdlib>

#include "tests/shared_data.h"

namespace kinescope::testing {

std::filesystem::path InSourceTree(const std::string& name) {
  return std::filesystem::path(KINESCOPE_SOURCE_DIR) / name;
}

std::filesystem::path InBuild(const std::string& name) {
  return std::filesystem::path(KINESCOPE_BUILD_DIR) / name;
}

std::filesystem::path SharedData(const std::string& file) {
  const char* folder = std::getenv("KINESCOPE_SHARED_DATA");
  return std::filesystem::path(folder != nullptr ? folder : KINESCOPE_SHARED_DATA_DEFAULT) / file;
}

}  // namespace kinescope::testing
