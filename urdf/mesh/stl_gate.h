/// Checks STL files before assimp reads them; see mesh_gate.h. Pure function, any thread.
#pragma once

#include <string>

namespace kinescope::urdf {

/// Binary or text. @throws std::runtime_error: a count that exceeds the bytes; in text, an invalid
/// triangle, with its line.
void CheckStl(const std::string& bytes);

}  // namespace kinescope::urdf
