#include "render/shape/visual_mesh.h"

#include <algorithm>
#include <stdexcept>

#include "core/palette.h"
#include "render/shape/texture_image.h"
#include "urdf/mesh/mesh_file.h"

namespace kinescope::render {
namespace {

constexpr double kPlaceholderSide = 0.12;                            // m
constexpr std::size_t kMaxVisualTriangles = 4'000'000;               // of one robot
const Eigen::Vector4f kPlaceholderColor = {0.85f, 0.62f, 0.80f, 1};  // not one of the palette's

std::string FileName(const std::string& uri) {
  const std::size_t slash = uri.find_last_of('/');
  return slash == std::string::npos ? uri : uri.substr(slash + 1);
}

double Reach(const urdf::Mesh& mesh, const Eigen::Affine3d& place) {
  double reach = 0;
  for (const Eigen::Vector3f& position : mesh.positions) {
    reach = std::max(reach, (place * position.cast<double>()).cwiseAbs().maxCoeff());
  }
  return reach;
}

}  // namespace

const VisualReader::File& VisualReader::Read(const std::string& uri) {
  std::unique_ptr<const File>& known = files_[uri];
  if (known != nullptr) return *known;
  auto file = std::make_unique<File>();
  if (person_files_) {
    try {
      file->mesh = ReadOfPerson(FileName(uri));
      file->is_closed = file->mesh.IsClosed();
    } catch (const std::exception& error) {
      file->fault = "mesh " + uri + ": " + error.what();
    }
    known = std::move(file);
    return *known;
  }
  const auto found = urdf::FindMesh(uri, search_);
  if (const auto* missing = std::get_if<urdf::MeshNotFound>(&found)) {
    file->fault = "mesh " + uri + ": " + missing->reason;
  } else {
    const auto& path = std::get<std::filesystem::path>(found);
    try {
      // The first ones have most, however many follow.
      constexpr std::size_t kShare = 5, kLeast = 1'000;
      urdf::TextureReading textures{DecodeTexture};
      textures.most_triangles =
          std::min(textures.most_triangles, std::max(textured_left_ / kShare, kLeast));
      file->mesh = urdf::ReadMeshFile(path, urdf::ColladaUp::kIgnored, &textures);
      file->is_closed = file->mesh.IsClosed();
      textured_left_ -= std::min(textured_left_, textures.triangles);
      for (const std::string& problem : textures.problems) {
        file->remarks.push_back("mesh " + uri + ": " + problem);
      }
    } catch (const std::exception& error) {
      file->fault = error.what();
    }
  }
  known = std::move(file);
  return *known;
}

urdf::Mesh VisualReader::ReadOfPerson(const std::string& name) const {
  const auto content = person_files_->Content(name);
  if (content == nullptr) throw std::runtime_error("not one of this person's meshes");
  return urdf::ReadMesh(*content, ".stl", {}, urdf::ColladaUp::kIgnored);
}

std::string VisualReader::FaultOf(const File& file, const urdf::Geometry& shape,
                                  const Eigen::Affine3d& place) const {
  if (!file.fault.empty()) return file.fault;
  const std::string mesh = "mesh " + shape.mesh_uri + ": ";
  if (shape.size.cwiseAbs().minCoeff() < 1e-12) return mesh + "its scale is 0";
  if (Reach(file.mesh, place) > urdf::kMaxMeters) {
    return mesh +
           "it is too large for a robot; if it is in millimetres, set scale=\"0.001 0.001 0.001\"";
  }
  if (triangles_ + file.mesh.triangles.size() / 3 > kMaxVisualTriangles) {
    return mesh + "all meshes together have too many triangles";
  }
  return "";
}

void VisualReader::AddMesh(const urdf::Visual& visual, int part, VisualMesh& to) {
  const urdf::Geometry& shape = visual.geometry;
  const std::size_t first = to.mesh.positions.size();
  const File& file = Read(shape.mesh_uri);
  const Eigen::Affine3d place =
      Eigen::Affine3d(visual.link_from_visual.matrix()) * Eigen::Scaling(shape.size);
  const std::string fault = FaultOf(file, shape, place);
  if (!fault.empty()) {
    to.problems.push_back(fault);
    to.placeholders.push_back(
        {part, visual.link_from_visual.translation(), "missing: " + FileName(shape.mesh_uri)});
    to.mesh.Append(urdf::BoxMesh(Eigen::Vector3d::Constant(kPlaceholderSide)),
                   Eigen::Affine3d(visual.link_from_visual.matrix()));
    to.mesh.Paint(first, kPlaceholderColor, part);
    return;
  }
  for (const std::string& remark : file.remarks) {
    const auto end = to.problems.end();
    if (std::find(to.problems.begin(), end, remark) == end) to.problems.push_back(remark);
  }
  triangles_ += file.mesh.triangles.size() / 3;
  to.is_closed = to.is_closed && file.is_closed;
  to.mesh.Append(file.mesh, place);
  const Eigen::Vector4f plain(static_cast<float>(kBodyColor[0]), static_cast<float>(kBodyColor[1]),
                              static_cast<float>(kBodyColor[2]), 1);
  to.mesh.Paint(first, visual.rgba ? Eigen::Vector4f(visual.rgba->cast<float>()) : plain, part);
  // A mesh that was painted keeps its colours, as in RViz: the URDF's is for what has none.
  if (file.mesh.colors.empty()) return;
  for (std::size_t i = 0; i < file.mesh.colors.size(); ++i) {
    if (file.mesh.colors[i].w() > 0) to.mesh.colors[first + i] = file.mesh.colors[i];
  }
}

void VisualReader::Add(const urdf::Visual& visual, int part, VisualMesh& to) {
  const std::size_t first = to.mesh.positions.size();
  AddOpaque(visual, part, to);
  if (visual.opacity >= 1) return;
  for (std::size_t i = first; i < to.mesh.colors.size(); ++i) {
    to.mesh.colors[i].w() *= static_cast<float>(visual.opacity);
  }
}

// But for what its colours say.
void VisualReader::AddOpaque(const urdf::Visual& visual, int part, VisualMesh& to) {
  const urdf::Geometry& shape = visual.geometry;
  const std::size_t first = to.mesh.positions.size();
  const Eigen::Affine3d place(visual.link_from_visual.matrix());
  Eigen::Vector4f color(static_cast<float>(kBodyColor[0]), static_cast<float>(kBodyColor[1]),
                        static_cast<float>(kBodyColor[2]), 1);
  if (visual.rgba) color = visual.rgba->cast<float>();
  switch (shape.kind) {
    case urdf::Geometry::Kind::kBox:
      to.mesh.Append(urdf::BoxMesh(shape.size, detail_), place);
      break;
    case urdf::Geometry::Kind::kCylinder:
      to.mesh.Append(urdf::CylinderMesh(shape.size.x(), shape.size.y(), detail_), place);
      break;
    case urdf::Geometry::Kind::kSphere:
      to.mesh.Append(urdf::SphereMesh(shape.size.x(), detail_), place);
      break;
    case urdf::Geometry::Kind::kMesh: AddMesh(visual, part, to); return;
  }
  to.mesh.Paint(first, color, part);
}

}  // namespace kinescope::render
