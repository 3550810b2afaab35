#include "urdf/mesh/mesh_file.h"

#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cctype>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <unordered_map>

#include "urdf/mesh/mesh_gate.h"

namespace kinescope::urdf {
namespace {

namespace fs = std::filesystem;
using Fault = std::runtime_error;

constexpr std::size_t kMaxVertices = 3 * kMaxMeshTriangles;
constexpr unsigned kMaxCorners = 1000;          // of a polygon: it takes their square to cut it up
constexpr std::size_t kMaxAtOnePoint = 20'000;  // vertices; smooth normals take their square

constexpr float kSmoothBelowDeg = 66;  // sharper creases stay creases

std::string LowerExtension(const fs::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

std::string ReadBytes(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    throw Fault(error ? error.message() : std::string("not a regular file"));
  }
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw Fault(error.message());
  if (size > kMaxMeshBytes) {
    throw Fault("larger than " + std::to_string(kMaxMeshBytes >> 20) + " MiB");
  }
  std::ifstream file(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!file.read(bytes.data(), static_cast<std::streamsize>(size))) throw Fault("cannot be read");
  return bytes;
}

// All that assimp gets to see: the file, and beside it the colours of an OBJ.
class OneFile : public Assimp::IOSystem {
 public:
  static constexpr const char* kName = "mesh";

  OneFile(const std::string& bytes, std::string extension, fs::path folder)
      : bytes_(bytes), name_(kName + std::move(extension)), folder_(std::move(folder)) {}

  bool Exists(const char* name) const override { return name == name_ || IsColors(name); }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* name, const char*) override {
    if (name == name_) return Stream(bytes_);
    if (!IsColors(name)) return nullptr;
    try {
      colors_ = ReadBytes(folder_ / fs::path(name).filename());
    } catch (const Fault&) {
      return nullptr;  // it is drawn without
    }
    return Stream(colors_);
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  static Assimp::IOStream* Stream(const std::string& bytes) {
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(bytes.data()),
                                      bytes.size(), false);
  }
  bool IsColors(const fs::path& name) const {
    std::error_code ignored;
    return !folder_.empty() && LowerExtension(name) == ".mtl" &&
           fs::is_regular_file(folder_ / name.filename(), ignored);
  }

  const std::string& bytes_;
  const std::string name_;
  const fs::path folder_;
  std::string colors_;  // of the newest stream
};

struct HashPoint {
  std::size_t operator()(const aiVector3D& p) const {
    std::size_t hash = 0;
    for (const float each : {p.x, p.y, p.z}) {
      hash = hash * 1'000'003 + std::hash<float>()(each);
    }
    return hash;
  }
};

// Before anything is done with what was read.
void CheckMesh(const aiMesh& mesh) {
  if (mesh.mNumVertices > 0 && mesh.mVertices == nullptr) throw Fault("it has no vertices");
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    if (face.mNumIndices > kMaxCorners) {
      throw Fault("a polygon has " + std::to_string(face.mNumIndices) + " corners; at most " +
                  std::to_string(kMaxCorners));
    }
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      if (face.mIndices[k] < mesh.mNumVertices) continue;
      throw Fault("a polygon has a corner " + std::to_string(face.mIndices[k]) + " of " +
                  std::to_string(mesh.mNumVertices) + " vertices");
    }
  }
  std::unordered_map<aiVector3D, std::size_t, HashPoint> at_point;
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    const aiVector3D& p = mesh.mVertices[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      throw Fault("vertex " + std::to_string(i) + " is not finite");
    }
    if (mesh.mNumVertices > kMaxAtOnePoint && ++at_point[p] > kMaxAtOnePoint) {
      throw Fault("more than " + std::to_string(kMaxAtOnePoint) + " corners at one point");
    }
  }
}

void CheckScene(const aiScene& scene) {
  std::size_t vertices = 0, faces = 0;
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    vertices += scene.mMeshes[i]->mNumVertices;
    faces += scene.mMeshes[i]->mNumFaces;
  }
  if (faces > kMaxMeshTriangles) {
    throw Fault("more than " + std::to_string(kMaxMeshTriangles) + " triangles");
  }
  if (vertices > kMaxVertices) {
    throw Fault("more than " + std::to_string(kMaxVertices) + " vertices");
  }
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) CheckMesh(*scene.mMeshes[i]);
}

Eigen::Vector3f ToEigen(const aiVector3D& v) { return {v.x, v.y, v.z}; }

Mesh ToMesh(const aiMesh& from) {
  Mesh mesh;
  for (unsigned i = 0; i < from.mNumVertices; ++i) {
    mesh.AddVertex(ToEigen(from.mVertices[i]),
                   from.mNormals != nullptr ? ToEigen(from.mNormals[i]) : Eigen::Vector3f::UnitZ());
  }
  for (unsigned i = 0; i < from.mNumFaces; ++i) {
    const aiFace& face = from.mFaces[i];
    if (face.mNumIndices != 3) continue;  // points and lines have no surface
    mesh.AddTriangle(face.mIndices[0], face.mIndices[1], face.mIndices[2]);
  }
  return mesh;
}

float FromLinear(float value) {
  return value <= 0.0031308f ? 12.92f * value : 1.055f * std::pow(value, 1 / 2.4f) - 0.055f;
}

// Opacity is not read: exporters of COLLADA disagree on which end is opaque.
std::optional<Eigen::Vector4f> ColorOf(const aiScene& scene, const aiMesh& mesh, bool is_linear) {
  if (mesh.mMaterialIndex >= scene.mNumMaterials) return std::nullopt;
  const aiMaterial& material = *scene.mMaterials[mesh.mMaterialIndex];
  if (material.GetTextureCount(aiTextureType_DIFFUSE) > 0) return std::nullopt;
  // assimp makes one up where the file has none.
  aiString name;
  if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS &&
      std::string_view(name.C_Str()) == AI_DEFAULT_MATERIAL_NAME) {
    return std::nullopt;
  }
  aiColor4D color;
  if (material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) return std::nullopt;
  Eigen::Vector4f rgba(color.r, color.g, color.b, 1);
  aiColor4D glow;
  if (material.Get(AI_MATKEY_COLOR_EMISSIVE, glow) == aiReturn_SUCCESS) {
    rgba.head<3>() += Eigen::Vector3f(glow.r, glow.g, glow.b);
  }
  if (!rgba.allFinite()) return std::nullopt;
  rgba = rgba.cwiseMax(0.0f).cwiseMin(1.0f);
  if (is_linear) {
    for (int i = 0; i < 3; ++i) rgba[i] = FromLinear(rgba[i]);
  }
  return rgba;
}

Eigen::Affine3d ToEigen(const aiMatrix4x4& m) {
  Eigen::Affine3d to = Eigen::Affine3d::Identity();
  to.matrix().topRows<3>() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3,
      m.c4;
  return to;
}

// The pictures of the materials of a scene: in the file itself, or beside it.
class TextureSource {
 public:
  /// `reading`: null: none is read.
  TextureSource(const aiScene& scene, const fs::path& folder, TextureReading* reading)
      : scene_(scene), folder_(folder), reading_(reading) {}

  std::size_t most_triangles() const { return reading_->most_triangles; }
  void Count(std::size_t triangles) { reading_->triangles += triangles; }
  /// Null: the mesh has none, or one that cannot be drawn on it, which is told.
  const Texture* Find(const aiMesh& mesh) {
    if (reading_ == nullptr || mesh.mMaterialIndex >= scene_.mNumMaterials) return nullptr;
    const aiMaterial& material = *scene_.mMaterials[mesh.mMaterialIndex];
    aiString name;
    if (material.GetTexture(aiTextureType_DIFFUSE, 0, &name) != aiReturn_SUCCESS) return nullptr;
    if (mesh.mTextureCoords[0] == nullptr) {
      Tell(name.C_Str(), "the mesh has no texture coordinates");
      return nullptr;
    }
    const auto [known, is_new] = textures_.try_emplace(name.C_Str());
    if (is_new) {
      try {
        known->second = Read(known->first);
      } catch (const std::exception& error) {
        Tell(known->first, error.what());
      }
    }
    return known->second ? &*known->second : nullptr;
  }

 private:
  void Tell(const std::string& name, const std::string& why) {
    reading_->problems.push_back("its texture '" + name + "' is not drawn: " + why);
  }

  Texture Read(const std::string& name) const {
    if (const aiTexture* const inside = scene_.GetEmbeddedTexture(name.c_str())) {
      if (inside->mHeight != 0) throw Fault("it is neither PNG nor JPEG");
      return reading_->decode(reinterpret_cast<const std::uint8_t*>(inside->pcData),
                              inside->mWidth);
    }
    const std::string bytes = ReadBytes(PathOf(name));
    return reading_->decode(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  }

  // Packages of robots have a folder for meshes and one for textures.
  fs::path PathOf(const std::string& name) const {
    std::string text = name;
    std::replace(text.begin(), text.end(), '\\', '/');
    constexpr std::string_view kFile = "file://";
    if (text.compare(0, kFile.size(), kFile) == 0) text.erase(0, kFile.size());
    const fs::path package = folder_.lexically_normal().parent_path();
    fs::path path = (folder_ / text).lexically_normal();  // an absolute one is as it is
    const bool is_there =
        !folder_.empty() &&
        std::mismatch(package.begin(), package.end(), path.begin(), path.end()).first ==
            package.end();
    if (is_there) return path;
    throw Fault("it is neither beside the mesh nor in a folder beside that of the mesh");
  }

  const aiScene& scene_;
  const fs::path folder_;
  TextureReading* const reading_;
  std::map<std::string, std::optional<Texture>> textures_;
};

std::vector<Eigen::Vector2f> PlacesOn(const aiMesh& mesh) {
  std::vector<Eigen::Vector2f> uv;
  uv.reserve(mesh.mNumVertices);
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    uv.emplace_back(mesh.mTextureCoords[0][i].x, mesh.mTextureCoords[0][i].y);
  }
  return uv;
}

// Every node's meshes where the node is.
class Collector {
 public:
  Collector(const aiScene& scene, const std::string& extension, TextureSource& textures)
      : scene_(scene),
        is_linear_(extension == ".glb"),
        is_collada_(extension == ".dae"),
        has_colors_(extension != ".stl") {
    for (unsigned i = 0; i < scene.mNumMeshes; ++i) meshes_.push_back(ToMesh(*scene.mMeshes[i]));
    Paint(textures);
  }

  Mesh Collect(const Eigen::Affine3d& world_from_root) {
    struct Open {
      const aiNode* node;
      Eigen::Affine3d world_from_parent;
    };
    std::vector<Open> open = {{scene_.mRootNode, world_from_root}};
    while (!open.empty()) {
      const Open at = open.back();
      open.pop_back();
      const Eigen::Affine3d world_from_node =
          at.world_from_parent * ToEigen(at.node->mTransformation);
      for (unsigned i = 0; i < at.node->mNumMeshes; ++i) {
        Add(at.node->mMeshes[i], world_from_node);
      }
      for (unsigned i = at.node->mNumChildren; i-- > 0;) {
        open.push_back({at.node->mChildren[i], world_from_node});
      }
    }
    if (!any_color_) mesh_.colors.clear();
    return std::move(mesh_);
  }

 private:
  // What several nodes show counts as often.
  void Paint(TextureSource& textures) {
    std::vector<std::size_t> uses(meshes_.size());
    std::vector<const aiNode*> open = {scene_.mRootNode};
    while (!open.empty()) {
      const aiNode& node = *open.back();
      open.pop_back();
      for (unsigned i = 0; i < node.mNumMeshes; ++i) ++uses.at(node.mMeshes[i]);
      open.insert(open.end(), node.mChildren, node.mChildren + node.mNumChildren);
    }
    std::vector<const Texture*> found;
    std::size_t textured = 0;
    for (std::size_t i = 0; i < meshes_.size(); ++i) {
      found.push_back(textures.Find(*scene_.mMeshes[i]));
      if (found[i] != nullptr) textured += uses[i];
    }
    for (std::size_t i = 0; i < meshes_.size() && textured > 0; ++i) {
      if (found[i] == nullptr) continue;
      const aiMesh& mesh = *scene_.mMeshes[i];
      PaintTexture(*found[i], PlacesOn(mesh), textures.most_triangles() / textured, meshes_[i]);
      textures.Count(uses[i] * meshes_[i].triangles.size() / 3);
      if (const auto tint = TintOf(mesh)) {
        for (Eigen::Vector4f& color : meshes_[i].colors) color = color.cwiseProduct(*tint);
      }
    }
  }

  // What a picture is multiplied with. COLLADA has a colour or a picture.
  std::optional<Eigen::Vector4f> TintOf(const aiMesh& mesh) const {
    const aiMaterial& material = *scene_.mMaterials[mesh.mMaterialIndex];
    aiColor4D color;
    if (is_collada_ || material.Get(AI_MATKEY_COLOR_DIFFUSE, color) != aiReturn_SUCCESS) {
      return std::nullopt;
    }
    Eigen::Vector4f tint(color.r, color.g, color.b, 1);
    if (!tint.allFinite()) return std::nullopt;
    tint = tint.cwiseMax(0.0f).cwiseMin(1.0f);
    for (int i = 0; i < 3 && is_linear_; ++i) tint[i] = FromLinear(tint[i]);
    return tint;
  }

  void Add(unsigned index, const Eigen::Affine3d& place) {
    const Mesh& mesh = meshes_.at(index);
    if (!(std::abs(place.linear().determinant()) > 1e-18) || !place.matrix().allFinite()) {
      throw Fault("a node has a scale of 0");
    }
    if (mesh_.triangles.size() + mesh.triangles.size() > 3 * kMaxMeshTriangles) {
      throw Fault("more than " + std::to_string(kMaxMeshTriangles) + " triangles");
    }
    const bool is_painted = !mesh.colors.empty();
    const auto color = has_colors_ && !is_painted
                           ? ColorOf(scene_, *scene_.mMeshes[index], is_linear_)
                           : std::nullopt;
    any_color_ = any_color_ || color || is_painted;
    mesh_.Append(mesh, place);
    // Zero opacity: none of its own.
    mesh_.colors.resize(mesh_.positions.size(), color.value_or(Eigen::Vector4f::Zero()));
  }

  const aiScene& scene_;
  const bool is_linear_, is_collada_, has_colors_;
  bool any_color_ = false;
  std::vector<Mesh> meshes_;
  Mesh mesh_;
};

// Six times the volume that the surface encloses; negative where triangles face inwards.
double SignedVolume(const Mesh& mesh) {
  // About their middle, which matters where the surface does not close.
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3f& position : mesh.positions) middle += position.cast<double>();
  middle /= static_cast<double>(mesh.positions.size());
  double volume = 0;
  for (std::size_t i = 0; i + 2 < mesh.triangles.size(); i += 3) {
    const auto corner = [&](std::size_t k) -> Eigen::Vector3d {
      return mesh.positions[mesh.triangles[i + k]].cast<double>() - middle;
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

Mesh ReadMeshFile(const fs::path& path, ColladaUp up, TextureReading* textures) try {
  return ReadMesh(ReadBytes(path), LowerExtension(path), path.parent_path(), up, textures);
} catch (const std::exception& error) {
  throw Fault("mesh " + path.string() + ": " + error.what());
}

Mesh ReadMesh(const std::string& bytes, const std::string& extension, const fs::path& folder,
              ColladaUp up, TextureReading* textures) {
  CheckMeshBytes(bytes, extension);
  Assimp::Importer importer;
  importer.SetIOHandler(new OneFile(bytes, extension, folder));  // it deletes it
  importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, kSmoothBelowDeg);
  const bool ignores_up = up == ColladaUp::kIgnored;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, ignores_up);
  const aiScene* scene = importer.ReadFile(OneFile::kName + extension, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) throw Fault(importer.GetErrorString());
  CheckScene(*scene);
  unsigned steps =
      aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_GenSmoothNormals;
  // STL has one normal a facet, which would keep equal corners apart and every edge visible.
  if (extension == ".stl") steps |= aiProcess_DropNormals;
  scene = importer.ApplyPostProcessing(steps);
  if (scene == nullptr) throw Fault(importer.GetErrorString());

  // assimp turns COLLADA's up axis to y by default, and y is GLB's anyway.
  Eigen::Affine3d world_from_root = Eigen::Affine3d::Identity();
  if (extension == ".glb" || (extension == ".dae" && !ignores_up)) {
    world_from_root.linear() << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  }
  TextureSource pictures(*scene, folder, textures);
  Mesh mesh = Collector(*scene, extension, pictures).Collect(world_from_root);
  if (mesh.triangles.empty()) throw Fault("it contains no triangles");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!mesh.positions[i].allFinite()) throw Fault("a vertex is not finite");
    if (!mesh.normals[i].allFinite()) mesh.normals[i] = Eigen::Vector3f::UnitZ();
  }
  TurnOutwards(mesh);
  return mesh;
}

}  // namespace kinescope::urdf
