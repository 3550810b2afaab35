// Any bytes as a mesh file of the kind, and turned the way, that the first of them says: refused
// with a reason, or a surface that can be drawn.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "core/system/check.h"
#include "urdf/mesh/mesh_file.h"

namespace mesh_file_fuzz {

// assimp leaks what it has made so far of many a file that it refuses; that is bounded by the file,
// which is read once.
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libassimp\n";
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kinescope::urdf;
  static constexpr std::array kExtensions = {".stl", ".dae", ".obj", ".glb"};
  if (size == 0) return 0;
  const std::string bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const bool ignores_up = data[0] / kExtensions.size() % 2 == 1;
    // A picture that is in the file is one of two pixels, whatever its bytes.
    TextureReading textures{[](const std::uint8_t* begin, std::size_t count) {
      if (count > 0) KINESCOPE_CHECK(begin[0] + begin[count - 1] >= 0);
      return Texture{2, 1, {255, 0, 0, 255, 0, 255, 0, 255}};
    }};
    const Mesh mesh = ReadMesh(bytes, kExtensions[data[0] % kExtensions.size()], "",
                               ignores_up ? ColladaUp::kIgnored : ColladaUp::kAsTold, &textures);
    KINESCOPE_CHECK(!mesh.triangles.empty() && mesh.triangles.size() % 3 == 0);
    KINESCOPE_CHECK(mesh.triangles.size() <= 3 * kMaxMeshTriangles);
    KINESCOPE_CHECK(mesh.normals.size() == mesh.positions.size());
    KINESCOPE_CHECK(mesh.colors.empty() || mesh.colors.size() == mesh.positions.size());
    for (const std::uint32_t corner : mesh.triangles) {
      KINESCOPE_CHECK(corner < mesh.positions.size());
    }
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      KINESCOPE_CHECK(mesh.positions[i].allFinite() && mesh.normals[i].allFinite());
    }
    static_cast<void>(mesh.IsClosed());
  } catch (const std::runtime_error& error) {
    KINESCOPE_CHECK(error.what()[0] != '\0');
  }
  return 0;
}

}  // namespace mesh_file_fuzz
