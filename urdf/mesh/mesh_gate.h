/// What a mesh file must be before a library is let near it. assimp believes counts, follows
/// references in circles and nests calls as deep as the file says.
#pragma once

#include <string>

namespace kinescope::urdf {

/// `extension` in lower case, with its dot. @throws std::runtime_error saying what is wrong.
void CheckMeshBytes(const std::string& bytes, const std::string& extension);

}  // namespace kinescope::urdf
