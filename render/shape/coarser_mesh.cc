#include "render/shape/coarser_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>

#include "core/system/check.h"

namespace kinescope::render {
namespace {

// Each part at a place of its own. meshoptimizer takes vertices at the same place for one, and
// those of a left and a right limb often are: it would leave them all as they are.
std::vector<Eigen::Vector3f> PartsApart(const urdf::Mesh& mesh) {
  float size = 0;
  for (const Eigen::Vector3f& position : mesh.positions) {
    size = std::max(size, position.cwiseAbs().maxCoeff());
  }
  std::vector<Eigen::Vector3f> apart = mesh.positions;
  for (std::size_t i = 0; i < apart.size(); ++i) apart[i].x() += 3 * size * mesh.parts[i];
  return apart;
}

// The vertices that are used, in the order of their use.
template <class T>
std::vector<T> Remapped(const std::vector<T>& values, std::size_t count,
                        const std::vector<unsigned>& remap) {
  std::vector<T> used(count);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (remap[i] != ~0U) used[remap[i]] = values[i];
  }
  return used;
}

}  // namespace

std::vector<std::uint32_t> CoarserTriangles(const std::vector<Eigen::Vector3f>& positions,
                                            const std::vector<std::uint32_t>& triangles,
                                            double error_m, OpenEdge edge) {
  KINESCOPE_CHECK(error_m > 0);
  if (triangles.empty()) return triangles;
  const float* const first = positions.front().data();
  constexpr std::size_t kStride = sizeof(positions.front());
  const float scale = meshopt_simplifyScale(first, positions.size(), kStride);
  if (!(scale > 0)) return triangles;
  std::vector<std::uint32_t> coarser(triangles.size());
  coarser.resize(meshopt_simplify(coarser.data(), triangles.data(), triangles.size(), first,
                                  positions.size(), kStride, 0, static_cast<float>(error_m) / scale,
                                  edge == OpenEdge::kStays ? meshopt_SimplifyLockBorder : 0,
                                  nullptr));
  meshopt_optimizeVertexCache(coarser.data(), coarser.data(), coarser.size(), positions.size());
  return coarser;
}

double PermittedError(std::initializer_list<double> errors, double error_m) {
  double permitted = 0;
  for (const double error : errors) {
    if (error <= error_m) permitted = error;
  }
  return permitted;
}

urdf::Mesh CoarserMesh(const urdf::Mesh& mesh, double error_m) {
  if (mesh.triangles.empty()) return mesh;
  std::vector<std::uint32_t> triangles =
      CoarserTriangles(PartsApart(mesh), mesh.triangles, error_m);
  std::vector<unsigned> remap(mesh.positions.size());
  const std::size_t count = meshopt_optimizeVertexFetchRemap(
      remap.data(), triangles.data(), triangles.size(), mesh.positions.size());
  meshopt_remapIndexBuffer(triangles.data(), triangles.data(), triangles.size(), remap.data());
  urdf::Mesh coarser;
  coarser.positions = Remapped(mesh.positions, count, remap);
  coarser.normals = Remapped(mesh.normals, count, remap);
  coarser.colors = Remapped(mesh.colors, count, remap);
  coarser.parts = Remapped(mesh.parts, count, remap);
  coarser.triangles = std::move(triangles);
  return coarser;
}

}  // namespace kinescope::render
