/// Finds files of this repository for tests that read them: documents, the page, golden images.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope::testing {

/// `name` is relative to the top folder of the repository.
std::filesystem::path InSourceTree(const std::string& name);

}  // namespace kinescope::testing
