/// Finds files of this repository and of this build for tests that read or start them: documents,
/// the page, golden images, programs.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope::testing {

/// `name` is relative to the top folder of the repository.
std::filesystem::path InSourceTree(const std::string& name);

/// `name` is relative to the build folder.
std::filesystem::path InBuild(const std::string& name);

}  // namespace kinescope::testing
