#include "server/picture/pinhole.h"

#include <gtest/gtest.h>

#include <string>

namespace kinescope::app {
namespace {

// K and the frame that go out put every point of the world where the renderer draws it: pixel 0 has
// its centre at 0 for ROS and half a pixel from the edge for us.
TEST(Pinhole, ProjectsPointsLikeTheCamera) {
  constexpr int kWidth = 640, kHeight = 360;
  for (const std::string& name : render::CameraNames()) {
    const render::Camera camera = render::NamedCamera(name, SceneState());
    const Pinhole pinhole = PinholeOf(camera, kHeight);
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.4, -0.3, 1.7), Eigen::Vector3d(-1, 1, 0)}) {
      const Eigen::Vector3d seen = pinhole.world_from_optical.orientation.conjugate() *
                                   (point - pinhole.world_from_optical.position);
      const render::Projected drawn = render::Project(point, camera, kWidth, kHeight);
      EXPECT_NEAR(seen.z(), drawn.depth_m, 1e-9) << name;
      EXPECT_NEAR((kWidth - 1) / 2.0 + pinhole.focal_px * seen.x() / seen.z() + 0.5, drawn.x_px,
                  1e-6)
          << name;
      EXPECT_NEAR((kHeight - 1) / 2.0 + pinhole.focal_px * seen.y() / seen.z() + 0.5, drawn.y_px,
                  1e-6)
          << name;
    }
  }
}

}  // namespace
}  // namespace kinescope::app
