/// The camera of an RViz configuration: its view controllers, as RViz 1.14 places them. Pure
/// functions.
#pragma once

#include <yaml-cpp/yaml.h>

#include <optional>
#include <string>

#include "render/camera/camera.h"

namespace kinescope::app::rviz {

struct View {
  render::Camera camera;  // world: that of the fixed frame, where the target frame is at its origin
  std::string
      why_not_as_saved;  // the class is missing or not RViz's own: RViz's first camera; "": it is
};

constexpr double kFarthestCamera = 1000;  // m, of a camera

/// As --camera, --fov and --projection have it.
struct CameraTexts {
  std::string place, fov, projection;
};
/// nullopt: it is farther away than kFarthestCamera.
std::optional<CameraTexts> CameraOptionsOf(const render::Camera& camera);

/// Of `current`, the member Current of Views. TopDownOrtho counts in pixels per metre: it shows
/// `height_px` of them.
View ViewOf(const YAML::Node& current, int height_px);

}  // namespace kinescope::app::rviz
