#include "render/shape/floor_scale.h"

#include <cmath>

namespace kinescope::render {
namespace {

constexpr int kScaleReach = 3;  // m, to either side of what the camera looks at
constexpr double kAside = 1;    // m, from there to the lines, so that no person stands on them

}  // namespace

void AddFloorScale(const Camera& camera, std::vector<Label>& labels) {
  const Eigen::Vector3d& middle = camera.target;
  if (!middle.allFinite() || middle.cwiseAbs().maxCoeff() > 1e6) return;
  const auto nearer = [&](int axis) {
    const double to_camera = camera.position[axis] - middle[axis];
    return std::round(middle[axis] + (to_camera < -1e-9 ? -kAside : kAside));
  };
  const double line_x = nearer(0), line_y = nearer(1);
  const auto add = [&](double x, double y, char axis, double metres) {
    const std::string text =
        std::string(1, axis) + " = " + std::to_string(std::lround(metres)) + " m";
    labels.push_back({{x, y, 0}, text, Label::Kind::kFloor});
  };
  for (int step = -kScaleReach; step <= kScaleReach; ++step) {
    const double x = std::round(middle.x()) + step, y = std::round(middle.y()) + step;
    add(x, line_y, 'x', x);
    if (y != line_y) add(line_x, y, 'y', y);  // where the lines meet, one is enough
  }
}

}  // namespace kinescope::render
