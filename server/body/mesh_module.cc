#include "server/body/mesh_module.h"

namespace kinescope::app {

urdf::TriangleMesh ReadMesh(const std::filesystem::path& path) {
  static const MeshModule& module =
      OpenModule<MeshModule>("libkinescope_meshes.so", "KinescopeMeshModule");
  const urdf::Mesh from = module.read(std::filesystem::absolute(path).string());
  urdf::TriangleMesh mesh;
  mesh.vertices = from.positions;
  mesh.triangles.reserve(from.triangles.size() / 3);
  for (std::size_t i = 0; i + 2 < from.triangles.size(); i += 3) {
    mesh.triangles.push_back({from.triangles[i], from.triangles[i + 1], from.triangles[i + 2]});
  }
  return mesh;
}

}  // namespace kinescope::app
