/// STL files looked over before assimp is given them; see mesh_gate.h.
#pragma once

#include <string>

namespace kinescope::urdf {

/// Binary or text. @throws std::runtime_error: a count that the bytes cannot hold; in text, what
/// makes no triangle, with its line.
void CheckStl(const std::string& bytes);

}  // namespace kinescope::urdf
