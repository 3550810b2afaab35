#include "server/picture/camera_json.h"

#include <nlohmann/json.hpp>

namespace kinescope::app {

std::vector<double> XyzList(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json CameraJson(const render::Camera& camera) {
  return {{"position_m", XyzList(camera.position)},
          {"target_m", XyzList(camera.target)},
          {"up", XyzList(camera.up)},
          {"vertical_fov_rad", camera.vertical_fov_rad}};
}

}  // namespace kinescope::app
