/// Visuals of a URDF as triangles: shapes, mesh files, and boxes with a label in place of meshes
/// that cannot be shown. What people and robots have in common.
#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "urdf/mesh/mesh.h"
#include "urdf/mesh_uri.h"
#include "urdf/robot_model.h"

namespace kinescope::render {

/// Several visuals as one mesh with a part for each link.
struct VisualMesh {
  struct Placeholder {
    int part = 0;
    Eigen::Vector3d center_in_link = Eigen::Vector3d::Zero();
    std::string label;  // the file that is missing
  };
  urdf::Mesh mesh;                        // positions in link frames
  bool is_closed = true;                  // no surface that could be seen from within
  std::vector<Placeholder> placeholders;  // drawn as boxes
  std::vector<std::string> problems;      // one line for each mesh that could not be shown
};

/// Adds visuals, reading each mesh file once. For one robot, or one person.
class VisualReader {
 public:
  VisualReader(urdf::MeshSearch search, const urdf::ShapeDetail& detail)
      : search_(std::move(search)), detail_(detail) {}

  /// Colours are those of the mesh file, where it has none the URDF's, else kBodyColor.
  void Add(const urdf::Visual& visual, int part, VisualMesh& to);

 private:
  struct File {
    urdf::Mesh mesh;
    bool is_closed = false;
    std::string fault;  // "": none
  };
  const File& Read(const std::string& uri);
  /// "": it can be shown.
  std::string FaultOf(const File& file, const urdf::Geometry& shape,
                      const Eigen::Affine3d& place) const;
  void AddMesh(const urdf::Visual& visual, int part, VisualMesh& to);

  const urdf::MeshSearch search_;
  const urdf::ShapeDetail detail_;
  std::map<std::string, std::unique_ptr<const File>> files_;  // by URI
  std::size_t triangles_ = 0;                                 // of all that was added
};

}  // namespace kinescope::render
