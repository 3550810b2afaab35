/// A camera as JSON, the same in provenance and in the output of commands. Pure functions, any
/// thread.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "render/camera/camera.h"

namespace kinescope::app {

/// As JSON takes it: x, y, z.
std::vector<double> XyzList(const Eigen::Vector3d& v);

/// {"position_m", "target_m", "up", "vertical_fov_rad"}; world.
nlohmann::ordered_json CameraJson(const render::Camera& camera);

}  // namespace kinescope::app
