/// Where the files that belong to the program lie: beside the executable in an install tree, in the
/// source tree when run from a build folder.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope {

/// The render module, such as "libkinescope_render_osmesa.so"; empty when it was not built.
std::filesystem::path FindModule(const std::string& file_name);

/// A file or folder of ours, such as "web"; empty when it is nowhere.
std::filesystem::path FindResource(const std::string& name);

}  // namespace kinescope
