#include "render/vtk/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <stdexcept>

namespace kinescope::render {
namespace {

// What a drawn person can need; a file beyond is a mistake, and would stall every picture.
constexpr std::uintmax_t kMostBytes = 64u << 20;
constexpr std::size_t kMostTriangles = 500'000;

constexpr float kSmoothBelowDeg = 66;  // sharper creases stay creases

std::string PercentDecoded(const std::string& text) {
  std::string decoded;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool is_escape = text[at] == '%' && at + 2 < text.size() &&
                           std::isxdigit(static_cast<unsigned char>(text[at + 1])) != 0 &&
                           std::isxdigit(static_cast<unsigned char>(text[at + 2])) != 0;
    if (is_escape) {
      decoded += static_cast<char>(std::stoi(text.substr(at + 1, 2), nullptr, 16));
      at += 2;
    } else {
      decoded += text[at];
    }
  }
  return decoded;
}

std::filesystem::path PathOf(const std::string& uri) {
  const std::string scheme = "file://";
  if (uri.compare(0, scheme.size(), scheme) == 0) return PercentDecoded(uri.substr(scheme.size()));
  return uri;
}

std::string LowerExtension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Eigen::Vector3f ToEigen(const aiVector3D& v) { return {v.x, v.y, v.z}; }

void Append(const aiMesh& from, Mesh& to) {
  const auto base = static_cast<std::uint32_t>(to.positions.size());
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    to.AddVertex(ToEigen(from.mVertices[i]),
                 from.mNormals != nullptr ? ToEigen(from.mNormals[i]) : Eigen::Vector3f::UnitZ());
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines have no surface
    to.AddTriangle(base + face.mIndices[0], base + face.mIndices[1], base + face.mIndices[2]);
  }
}

// Six times the volume that the surface encloses; negative where triangles face inwards.
double SignedVolume(const Mesh& mesh) {
  double volume = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.positions[mesh.triangles[i + k]].cast<double>();
    };
    volume += corner(0).dot(corner(1).cross(corner(2)));
  }
  return volume;
}

// Faces that look away may be left out, and some exporters wind all triangles the wrong way round.
void TurnOutwards(Mesh& mesh) {
  if (SignedVolume(mesh) >= 0) return;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    std::swap(mesh.triangles[i + 1], mesh.triangles[i + 2]);
  }
  for (Eigen::Vector3f& normal : mesh.normals) normal = -normal;
}

}  // namespace

Mesh ReadMeshFile(const std::string& uri) {
  const std::filesystem::path path = PathOf(uri);
  const auto fail = [&](const std::string& why) -> std::runtime_error {
    return std::runtime_error("mesh " + uri + ": " + why);
  };
  if (!path.is_absolute()) throw fail("only file:// and absolute paths are read");
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  if (error) throw fail(error.message());
  if (size > kMostBytes) throw fail("larger than " + std::to_string(kMostBytes >> 20) + " MiB");

  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothBelowDeg);
  unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                   aiProcess_GenSmoothNormals | aiProcess_PreTransformVertices;
  // STL has one normal a facet, which would keep equal corners apart and every edge visible.
  if (LowerExtension(path) == ".stl") steps |= aiProcess_DropNormals;
  const aiScene* scene = importer.ReadFile(path.string(), steps);
  if (scene == nullptr) throw fail(importer.GetErrorString());

  Mesh mesh;
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) {
    Append(*scene->mMeshes[i], mesh);
    if (mesh.triangles.size() > 3 * kMostTriangles) {
      throw fail("more than " + std::to_string(kMostTriangles) + " triangles");
    }
  }
  if (mesh.triangles.empty()) throw fail("holds no triangles");
  TurnOutwards(mesh);
  return mesh;
}

}  // namespace kinescope::render
