/// A robot beside the people. World frame, metres.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "urdf/robot/mesh_uri.h"
#include "urdf/robot/robot_model.h"

namespace kinescope {

/// Any robot with a URDF, shown beside the people.
struct RobotState {
  std::string name;
  std::shared_ptr<const urdf::RobotModel> model;  // never null
  std::shared_ptr<const urdf::MeshSearch>
      meshes;  // where its meshes are; null: absolute paths only
  /// In the order of model->links (urdf::PlaceLinks). A link that is nowhere has a pose that is not
  /// finite, and is not drawn.
  std::vector<Eigen::Isometry3d> world_from_link;
  Eigen::AlignedBox3d bounds;  // of its rendered shapes (render::Renderer::Bounds); empty: unknown
  /// Each state has places of its own; else it stands, and moves with the floor alone.
  bool moves = false;
  std::string problem = {};  // one line that viewers should read: which links are nowhere; or ""
};

/// Numbers of the links that have visuals, in the order of model->links.
inline std::vector<std::size_t> LinksToDraw(const urdf::RobotModel& model) {
  std::vector<std::size_t> links;
  for (std::size_t i = 0; i < model.links.size(); ++i) {
    if (!model.links[i].visuals.empty()) links.push_back(i);
  }
  return links;
}

/// All of a scene at a time. Shared, so that a robot that stays where it is costs
/// nothing.
using RobotList = std::vector<std::shared_ptr<const RobotState>>;

}  // namespace kinescope
