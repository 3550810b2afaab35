/// What is beside the people, external markers and robots, as a GLB (glTF 2.0), so that the page
/// shows the triangles that pictures show. A module that is loaded on demand, because reading mesh
/// files takes assimp.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/scene_marker.h"
#include "core/scene_state.h"
#include "core/system/module_loader.h"

namespace kinescope::render {

/// Keeps the meshes that it has read. One thread.
class SurroundingsWriter {
 public:
  virtual ~SurroundingsWriter() = default;

  /// World, metres, in the axes of GLB. Its nodes are named "markers" and "robot NAME". What others
  /// lie on, such as maps, has the material "ground", and its triangles are in the order in which
  /// they are to be drawn. Of a robot
  /// that moves, the node has `extras` with `robot`, its number among these, and below it a node
  /// for each link, in the frame of the link, with `link`, its number in LinksToDraw(). The points
  /// of a marker are a node "points" with `extras`: `size`, width and height of their squares, in m
  /// or, with `in_pixels`, in pixels of the page. A text is a node "label" with `extras`: `text`,
  /// `height` of a capital in m (0: a note of fixed size), `color` (sRGB) and `opacity`. The
  /// `extras` of the scene have `problems`: what is not shown as it should be, one line each.
  /// @pre each robot has a model
  virtual std::string Write(const std::vector<std::shared_ptr<const SceneMarker>>& markers,
                            const std::vector<RobotState>& robots) = 0;
};

/// @throws ModuleError if the module cannot be loaded.
std::unique_ptr<SurroundingsWriter> MakeSurroundingsWriter();

struct SurroundingsModule {
  ModuleAbi<SceneMarker, RobotState, urdf::RobotModel, urdf::Link, urdf::Visual, urdf::Collision,
            urdf::RobotJoint, urdf::MeshSearch, urdf::MeshNotFound>
      abi;
  std::unique_ptr<SurroundingsWriter> (*make)();
};

inline constexpr const char* kSurroundingsEntry = "KinescopeSurroundingsModule";

}  // namespace kinescope::render
