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

/// Of `current`, the member Current of Views. TopDownOrtho counts in pixels per metre: it shows
/// `height_px` of them.
View ViewOf(const YAML::Node& current, int height_px);

}  // namespace kinescope::app::rviz
