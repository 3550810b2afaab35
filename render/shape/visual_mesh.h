/// Converts visuals of a URDF to triangles: shapes, mesh files, and placeholder boxes with a label
/// for meshes that cannot be shown. Used for people and robots. Link frames, metres. One thread.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/mesh_files.h"
#include "urdf/mesh/mesh.h"
#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_model.h"

namespace kinescope::render {

/// Several visuals as one mesh with one part per link.
struct VisualMesh {
  struct Placeholder {
    int part = 0;
    Eigen::Vector3d center_in_link = Eigen::Vector3d::Zero();
    std::string label;  // name of the missing file
  };
  urdf::Mesh mesh;                        // positions in link frames
  bool is_closed = true;                  // no surface is visible from its back
  std::vector<Placeholder> placeholders;  // rendered as boxes
  std::vector<std::string> problems;      // one line per mesh, or texture, that cannot be shown
};

/// 0..1; of the URDF's colour, 1 where it names none.
inline double OpacityOf(const urdf::Visual& visual) {
  return visual.opacity * (visual.rgba ? visual.rgba->w() : 1);
}

/// Whether a link has a place in a picture: a finite one that is not absurdly far away.
inline bool CanBeDrawn(const Eigen::Isometry3d& world_from_link) {
  constexpr double kFarthest = 1e6;  // m
  return world_from_link.matrix().allFinite() &&
         world_from_link.translation().cwiseAbs().maxCoeff() < kFarthest;
}

/// Adds visuals; reads each mesh file once. Use one reader per robot or person.
class VisualReader {
 public:
  VisualReader(urdf::MeshSearch search, const urdf::ShapeDetail& detail)
      : search_(std::move(search)), detail_(detail) {}

  /// Of a person: reads the meshes from `files`. Null: from the files of absolute paths.
  VisualReader(std::shared_ptr<const MeshFiles> files, const urdf::ShapeDetail& detail)
      : detail_(detail), person_files_(std::move(files)) {}

  /// Colours are those of the mesh file, else those of the URDF, else kBodyColor.
  void Add(const urdf::Visual& visual, int part, VisualMesh& to);

 private:
  struct File {
    urdf::Mesh mesh;
    bool is_closed = false;
    std::string fault;                 // "": no error
    std::vector<std::string> remarks;  // what of it is not drawn
  };
  const File& Read(const std::string& uri);
  void AddOpaque(const urdf::Visual& visual, int part, VisualMesh& to);
  urdf::Mesh ReadOfPerson(const std::string& name) const;
  /// Why the mesh cannot be shown; "" if it can.
  std::string FaultOf(const File& file, const urdf::Geometry& shape,
                      const Eigen::Affine3d& place) const;
  void AddMesh(const urdf::Visual& visual, int part, VisualMesh& to);

  const urdf::MeshSearch search_;
  const urdf::ShapeDetail detail_;
  const std::shared_ptr<const MeshFiles> person_files_;
  std::map<std::string, std::unique_ptr<const File>> files_;  // by URI
  std::size_t triangles_ = 0;                                 // of all added visuals
  std::size_t textured_left_ = 100'000;                       // triangles for pictures
};

}  // namespace kinescope::render
