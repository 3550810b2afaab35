/// Checks the bytes of a mesh file before a library reads them: assimp trusts counts, follows
/// circular references and recurses as deep as the file demands. Pure function, any thread.
#pragma once

#include <string>

namespace kinescope::urdf {

/// `extension` in lower case, with its dot. @throws std::runtime_error with the reason.
void CheckMeshBytes(const std::string& bytes, const std::string& extension);

}  // namespace kinescope::urdf
