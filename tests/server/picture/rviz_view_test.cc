#include "server/picture/rviz_view.h"

#include <gmock/gmock.h>

#include <cmath>
#include <string>

#include "render/camera/camera.h"
#include "server/picture/camera_options.h"
#include "tests/server/picture/rviz_fixture.h"

namespace kinescope::app {
namespace {

using Eigen::Vector3d;
using kinescope::testing::kRvizHeight;
using kinescope::testing::kRvizWidth;
using kinescope::testing::ReadText;
using kinescope::testing::SettingsOf;
using kinescope::testing::WithView;
using ::testing::Contains;
using ::testing::HasSubstr;

/// The camera as the options of a picture make it.
render::Camera CameraOf(const std::string& view) {
  const auto settings = SettingsOf(ReadText(WithView(view)));
  render::Camera camera = ParseCamera(settings.at("camera")).place.value();
  camera.vertical_fov_rad = std::stod(settings.at("fov")) * M_PI / 180;
  return settings.at("projection") == "orthographic" ? render::Orthographic(camera) : camera;
}

render::Projected Seen(const Vector3d& point, const render::Camera& camera) {
  return render::Project(point, camera, kRvizWidth, kRvizHeight);
}

TEST(RvizView, OrbitStandsWhereRvizHasIt) {
  const render::Camera camera = CameraOf(
      "      {Class: rviz/Orbit, Distance: 5, Yaw: 0, Pitch: 0.5, Field of View: 0.9,\n"
      "       Focal Point: {X: 1, Y: 2, Z: 0.5}}\n");
  EXPECT_LT((camera.position - Vector3d(1 + 5 * std::cos(0.5), 2, 0.5 + 5 * std::sin(0.5))).norm(),
            1e-9);
  EXPECT_LT((camera.target - Vector3d(1, 2, 0.5)).norm(), 1e-9);
  EXPECT_NEAR(camera.vertical_fov_rad, 0.9, 1e-9);
}

TEST(RvizView, OrbitUpsideDownHasItsCameraBelow) {
  const render::Camera camera =
      CameraOf("      {Class: rviz/Orbit, Distance: 5, Yaw: 0, Pitch: 0.5, Invert Z Axis: true}\n");
  EXPECT_LT(camera.position.z(), -2);
  EXPECT_GT(Seen({0, 0, 1}, camera).y_px, kRvizHeight / 2.0) << "what is high is below";
}

// Measured in RViz: the point is 24 % of the height below the middle.
TEST(RvizView, XyOrbitShowsItsFocusBelowTheMiddle) {
  for (const char* kind : {"rviz/XYOrbit", "rviz/ThirdPersonFollower"}) {
    const render::Camera camera =
        CameraOf("      {Class: " + std::string(kind) + ", Distance: 5, Yaw: 0.3, Pitch: 0.6}\n");
    const render::Projected focus = Seen(Vector3d::Zero(), camera);
    EXPECT_NEAR(focus.x_px, kRvizWidth / 2.0, 1e-6);
    EXPECT_NEAR(focus.y_px / kRvizHeight, 0.5 + 0.2 / std::tan(M_PI / 8) / 2, 1e-6);
  }
}

TEST(RvizView, FirstPersonLooksDownWithPitchAndLeansWithRoll) {
  const render::Camera camera = CameraOf(
      "      {Class: rviz/FPS, Yaw: 1.5707963267948966, Pitch: 0.5, Roll: 0,\n"
      "       Position: {X: 0, Y: 0, Z: 2}}\n");
  const Vector3d ahead = (camera.target - camera.position).normalized();
  EXPECT_LT((ahead - Vector3d(0, std::cos(0.5), -std::sin(0.5))).norm(), 1e-6);
  const render::Camera leaning = CameraOf("      {Class: rviz/FPS, Roll: 0.5}\n");
  EXPECT_LT((leaning.up - Vector3d(0, -std::sin(0.5), std::cos(0.5))).norm(), 1e-6);
}

TEST(RvizView, TopDownHasPixelsPerMetre) {
  const render::Camera camera =
      CameraOf("      {Class: rviz/TopDownOrtho, Scale: 100, Angle: 0, X: 1, Y: 2}\n");
  const render::Projected middle = Seen({1, 2, 0}, camera), right = Seen({2, 2, 0}, camera),
                          up = Seen({1, 3, 1.8}, camera);
  EXPECT_NEAR(middle.x_px, kRvizWidth / 2.0, 1e-3);
  EXPECT_NEAR(middle.y_px, kRvizHeight / 2.0, 1e-3);
  EXPECT_NEAR(right.x_px - middle.x_px, 100, 1e-3);
  EXPECT_NEAR(middle.y_px - up.y_px, 100, 1e-3);
}

TEST(RvizView, TopDownTurnsWithItsAngle) {
  const render::Camera camera =
      CameraOf("      {Class: rviz/TopDownOrtho, Scale: 50, Angle: 0.5}\n");
  EXPECT_LT(Seen({0, 0, 0}, camera).y_px, Seen({1, 0, 0}, camera).y_px)
      << "the scene turns the other way: +x points down to the right";
}

TEST(RvizView, NamesAViewThatIsNotOfRviz) {
  const RvizPicture picture =
      ReadText(WithView("      {Class: plugin/Animated, Target Frame: base_link}\n"));
  EXPECT_THAT(picture.remarks, Contains(HasSubstr("4: the view 'plugin/Animated' is not one of")));
}

TEST(RvizView, HasTheFrameThatTheViewGoesWith) {
  const auto target_of = [](const std::string& view) {
    const RvizPicture::Target target = ReadText(WithView("      {" + view + "}\n")).target;
    return target.frame + target.turn;
  };
  EXPECT_EQ(target_of("Class: rviz/Orbit, Target Frame: /base_link"), "base_link");
  EXPECT_EQ(target_of("Class: rviz/Orbit, Target Frame: <Fixed Frame>"), "");
  EXPECT_EQ(target_of("Class: rviz/XYOrbit, Target Frame: map"), "") << "it is the fixed frame";
  EXPECT_EQ(target_of("Class: rviz/ThirdPersonFollower, Target Frame: cart"), "cart:heading");
  EXPECT_EQ(target_of("Class: rviz/FrameAligned, Target Frame: cam"), "cam:pose");
}

TEST(RvizView, FollowsNothingInAViewThatRvizCannotLoad) {
  EXPECT_EQ(ReadText(WithView("      {Target Frame: base_link}\n")).target.frame, "");
  EXPECT_EQ(ReadText(WithView("      {Class: rviz/Orbit, Target Frame: base_link}\n")).target.frame,
            "base_link");
}

// A pixel of a view from above is 0.5 mm, or 1 m.
TEST(RvizView, HasTheScaleOfAnyViewFromAbove) {
  for (const double scale : {2000.0, 1.0}) {
    const render::Camera camera =
        CameraOf("      {Class: rviz/TopDownOrtho, Scale: " + std::to_string(scale) + "}\n");
    EXPECT_NEAR(camera.ortho_height_m, kRvizHeight / scale, 1e-3 * kRvizHeight / scale);
    EXPECT_GT(camera.position.z(), 1);
  }
  for (const char* scale : {"0.02", "0", "no number"}) {  // the camera would be too far away
    const RvizPicture far =
        ReadText(WithView(std::string("      {Class: rviz/TopDownOrtho, Scale: ") + scale + "}\n"));
    EXPECT_EQ(SettingsOf(far).count("camera"), 0U) << scale;
    EXPECT_THAT(far.remarks, Contains(HasSubstr("more than 1000 m away"))) << scale;
  }
  const render::Camera turned = CameraOf("      {Class: rviz/TopDownOrtho, Scale: -10}\n");
  EXPECT_NEAR(turned.up.y(), -1, 1e-9);
}

TEST(RvizView, ReadsValuesAsRvizDoes) {
  const auto camera = CameraOf(
      "      {Class: rviz/Orbit, Distance: five, Yaw: 0, Pitch: 9, Focal Point: {X: 1, Y: 2}}\n");
  EXPECT_NEAR(camera.position.norm(), 0.001, 1e-9)
      << "0, which is too near, from a point without Z";
  const auto settings = SettingsOf(ReadText(
      WithDisplays("    - {Class: rviz/Grid, Enabled: no, Name: any text but false is true}\n",
                   "  Global Options: {Background Color: 300; -5; 7}\n")));
  EXPECT_EQ(settings.at("floor"), "on");
  EXPECT_EQ(settings.at("background"), "#ff0007");
}

}  // namespace
}  // namespace kinescope::app
