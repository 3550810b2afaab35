#include "render/camera/image_view.h"

#include <algorithm>
#include <cmath>

namespace kinescope::render {
namespace {

// Of one of the two directions, px.
struct Span {
  int whole = 0;  // an axis in its middle
  int first = 0;  // of the image
};

Span SpanOf(double center, int shown) {
  const double half = std::ceil(std::max(center, shown - center));
  return {2 * static_cast<int>(half), static_cast<int>(std::lround(half - center))};
}

}  // namespace

ImageView ViewOf(const ImageCamera& taken_by, int width_px, int height_px) {
  constexpr double kToCenterOfPixel = 0.5;  // from its edge
  const double across = static_cast<double>(width_px) / taken_by.width;
  const double down = static_cast<double>(height_px) / taken_by.height;
  const Span x = SpanOf(across * (taken_by.center_px[0] + kToCenterOfPixel), width_px);
  const Span y = SpanOf(down * (taken_by.center_px[1] + kToCenterOfPixel), height_px);
  const double focal = 0.5 * (across * taken_by.focal_px[0] + down * taken_by.focal_px[1]);
  const urdf::Pose& pose = taken_by.world_from_optical;
  ImageView view;
  view.camera.position = pose.position;
  view.camera.target = pose.position + pose.orientation * Eigen::Vector3d::UnitZ();
  view.camera.up = pose.orientation * -Eigen::Vector3d::UnitY();
  view.camera.vertical_fov_rad = 2 * std::atan2(0.5 * y.whole, focal);
  view.width = x.whole;
  view.height = y.whole;
  view.image = {x.first, y.first, width_px, height_px};
  return view;
}

}  // namespace kinescope::render
