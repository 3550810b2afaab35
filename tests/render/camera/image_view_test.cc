// A scene as the camera of an image sees it: points are where the calibration says.
#include "render/camera/image_view.h"

#include <gtest/gtest.h>

#include <limits>

namespace kinescope::render {
namespace {

using Eigen::Vector3d;

// At (1, 2, 1.5), looks along +x of the world: its x is the world's -y, its y the world's -z.
ImageCamera SomeCamera() {
  ImageCamera camera;
  camera.world_from_optical.position = {1, 2, 1.5};
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.world_from_optical.orientation = Eigen::Quaterniond(axes);
  camera.width = 640;
  camera.height = 480;
  camera.focal_px = {525, 525};
  camera.center_px = {319.5, 239.5};
  return camera;
}

// px of the image, from its upper left corner.
Eigen::Vector2d PlaceIn(const ImageView& view, const Vector3d& point) {
  const Projected at = Project(point, view.camera, view.width, view.height);
  EXPECT_GT(at.depth_m, 0);
  return {at.x_px - view.image.x, at.y_px - view.image.y};
}

TEST(ImageView, HasPointsWhereTheCalibrationHasThem) {
  for (const double center_x : {319.5, 250.0, 420.25, -100.0}) {
    for (const double center_y : {239.5, 100.0, 300.75, 600.0}) {
      ImageCamera camera = SomeCamera();
      camera.center_px = {center_x, center_y};
      ASSERT_EQ(FindDefect(camera), "");
      const int width = 320, height = 240;
      const ImageView view = ViewOf(camera, width, height);
      EXPECT_GE(view.image.x, 0);
      EXPECT_GE(view.image.y, 0);
      EXPECT_EQ(view.image.width, width);
      EXPECT_EQ(view.image.height, height);
      EXPECT_LE(view.image.x + width, view.width);
      EXPECT_LE(view.image.y + height, view.height);
      // 2 m ahead, 0.3 m to the right, 0.2 m down.
      const Eigen::Vector2d at = PlaceIn(view, {3, 1.7, 1.3});
      const double scale = 0.5, middle = 0.5;
      EXPECT_NEAR(at.x(), scale * (center_x + middle + 525 * 0.3 / 2), 0.5);
      EXPECT_NEAR(at.y(), scale * (center_y + middle + 525 * 0.2 / 2), 0.5);
    }
  }
}

TEST(ImageView, GoesWithTheCamera) {
  ImageCamera camera = SomeCamera();
  const Eigen::Vector2d before = PlaceIn(ViewOf(camera, 640, 480), {3, 1.7, 1.3});
  const Vector3d by(0.4, -3, 0.2);
  camera.world_from_optical.position += by;
  EXPECT_LT((PlaceIn(ViewOf(camera, 640, 480), Vector3d(3, 1.7, 1.3) + by) - before).norm(), 1e-6);
}

TEST(ImageCamera, ThatCannotBeNamesItsDefect) {
  const auto defect_with = [](auto&& change) {
    ImageCamera camera = SomeCamera();
    change(camera);
    return FindDefect(camera);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(defect_with([](ImageCamera&) {}), "");
  EXPECT_EQ(defect_with([](ImageCamera& of) { of.width = 0; }), "it was calibrated for 0 x 480 px");
  for (const double focal : {0.0, -525.0, kNan}) {
    EXPECT_EQ(defect_with([&](ImageCamera& of) { of.focal_px[0] = focal; }),
              "its focal lengths are not positive");
  }
  EXPECT_EQ(defect_with([](ImageCamera& of) { of.focal_px[0] = 700; }),
            "its focal lengths differ by more than a tenth");
  EXPECT_EQ(defect_with([](ImageCamera& of) {
              of.focal_px = {10, 10};
            }),
            "its focal length is not that of a pinhole camera");
  for (const double center : {-1000.0, 5000.0, kNan}) {
    EXPECT_EQ(defect_with([&](ImageCamera& of) { of.center_px[1] = center; }),
              "its axis is far from its image");
  }
  EXPECT_EQ(defect_with([](ImageCamera& of) { of.world_from_optical.position.z() = kNan; }),
            "its place is not finite");
}

}  // namespace
}  // namespace kinescope::render
