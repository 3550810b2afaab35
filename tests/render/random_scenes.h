/// Scenes that have all there is to draw, at random: people who come, go, jump and cross, all
/// elements, looks and sizes. For tests of whether a drawing is the same by other ways.
#pragma once

#include <memory>
#include <random>
#include <vector>

#include "core/scene_state.h"
#include "render/camera/camera.h"
#include "render/renderer.h"

namespace kinescope::testing {

class RandomScenes {
 public:
  /// Equal seeds give equal scenes.
  explicit RandomScenes(unsigned seed);

  /// A view: camera or several of them, size, look and overlays. Sides of `largest_px` at most.
  struct View {
    render::Camera camera;
    render::PictureSpec spec;
  };
  View NextView(int largest_px);
  /// What is in the scene at the next moment, and its trails and ghosts in `look`.
  SceneState NextState(render::SceneLook& look);

 private:
  double Uniform(double from, double to);
  bool Chance(double share);
  int Below(int count);
  Eigen::Vector3d Place();
  void AddOverlays(render::PictureSpec& spec);
  render::Camera RandomCamera();
  PersonState Person(int character);
  std::shared_ptr<const SceneMarker> Marker(int id);
  RobotState Robot();

  std::mt19937 random_;
  std::vector<std::shared_ptr<const PersonModel>> models_;
  std::shared_ptr<const urdf::RobotModel> robot_;
  std::vector<PersonState> people_;
  std::vector<std::shared_ptr<const SceneMarker>> markers_;
  std::vector<Eigen::Vector3d> trail_;
};

}  // namespace kinescope::testing
