/// A camera's keys as a YAML file says them (docs/pictures.md).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/camera/camera.h"
#include "render/camera/camera_path.h"

namespace kinescope::app {

/// One key; its camera is known when the scene is.
struct CameraKeySpec {
  double secs = 0;
  std::string name;  // a named camera; "": `place`
  render::Camera place;
  std::optional<double> fov_rad;
  render::Ease ease = render::Ease::kSmooth;
};

/// Times ascend. @throws UsageError naming file, line, key and what was expected.
std::vector<CameraKeySpec> ReadCameraKeys(const std::string& path);
/// `text`: the content of `path`, which is not opened. @throws UsageError as above.
std::vector<CameraKeySpec> ParseCameraKeys(const std::string& path, const std::string& text);

/// "X,Y,Z" in m, each within 1000. nullopt for anything else.
std::optional<Eigen::Vector3d> ParsePoint(const std::string& text);

/// A camera at `position` that looks at `target`, z up. nullopt where both are the same.
std::optional<render::Camera> CameraFromTo(const Eigen::Vector3d& position,
                                           const Eigen::Vector3d& target);

}  // namespace kinescope::app
