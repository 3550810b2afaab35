/// Finds the files that belong to the program: next to the executable in an install tree, in the
/// source tree when run from a build folder.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope {

/// Path of a render module, such as "libkinescope_render_osmesa.so"; empty if it was not built.
std::filesystem::path FindModule(const std::string& file_name);

/// Path of a file or folder of Kinescope, such as "web"; empty if not found.
std::filesystem::path FindResource(const std::string& name);

/// The program of all commands, which bin/kinescope starts; empty if it was not built.
std::filesystem::path FindProgram();

}  // namespace kinescope
