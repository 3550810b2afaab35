/// Finds the files that belong to the program: next to the executable in an install tree, in the
/// source tree when run from a build folder.
#pragma once

#include <filesystem>
#include <string>

namespace kinescope {

/// Path of a module, such as "libkinescope_render_osmesa.so"; empty if it was not built.
std::filesystem::path FindModule(const std::string& file_name);

/// Path of a file or folder of Kinescope, such as "web"; empty if not found.
std::filesystem::path FindResource(const std::string& name);

/// The page's modules in one file; empty if it was not built.
std::filesystem::path FindWebBundle();

/// Those that bin/kinescope starts: of what shows a person, and of all else.
constexpr char kMainProgram[] = "kinescope", kToolsProgram[] = "kinescope_tools";

/// One of them; empty if it was not built.
std::filesystem::path FindProgram(const std::string& name);

/// The folder in which this program was built; empty if it is not there, as after an installation.
std::filesystem::path FindBuildFolder();

}  // namespace kinescope
