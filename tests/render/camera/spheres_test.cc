#include "render/camera/spheres.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::LoadOf;
using kinescope::testing::MixedScene;
using kinescope::testing::Posture;
using kinescope::testing::SceneWith;

constexpr int kSpheresWidth = 1280, kSpheresHeight = 720;

PictureSpec PlainView(int supersample = 1) {
  PictureSpec spec;
  spec.width = kSpheresWidth;
  spec.height = kSpheresHeight;
  spec.supersample = supersample;
  spec.overlays = false;
  return spec;
}

const SphereInPicture& Find(const std::vector<SphereInPicture>& spheres, const std::string& joint) {
  for (const SphereInPicture& sphere : spheres) {
    if (sphere.joint == joint) return sphere;
  }
  throw std::logic_error("no sphere at " + joint);
}

TEST(Spheres, AreAtTheProjectionsOfTheirJoints) {
  const SceneState state = SceneWith(Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  const auto spheres = LocateSpheres(state, camera, kSpheresWidth, kSpheresHeight);
  ASSERT_EQ(spheres.size(), state.people[0].loads.size());
  const SphereInPicture& elbow = Find(spheres, "right_elbow");
  const Projected expected = Project(state.people[0].links[urdf::kRightForeArm].position, camera,
                                     kSpheresWidth, kSpheresHeight);
  EXPECT_NEAR(elbow.x_px, expected.x_px, 1e-9);
  EXPECT_NEAR(elbow.y_px, expected.y_px, 1e-9);
  EXPECT_LT(elbow.x_px, kSpheresWidth / 2) << "seen from the front, the right arm is on the left";
  EXPECT_GT(elbow.radius_px, 5);
}

TEST(Spheres, ShowEveryClassReadably) {
  const auto renderer = MakeRenderer();
  for (const LoadClass load_class :
       {LoadClass::kUnknown, LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
    const SceneState state = SceneWith(Posture::kStanding, load_class);
    const Camera camera = NamedCamera("front", state);
    for (const int supersample : {1, 2}) {
      const Image image = renderer->Render(state, camera, PlainView(supersample));
      const auto spheres = LocateSpheres(state, camera, kSpheresWidth, kSpheresHeight);
      int readable = 0;
      for (std::size_t i = 0; i < spheres.size(); ++i) {
        const Reading reading = ReadSphere(image, spheres, i);
        if (!reading.is_readable) continue;
        ++readable;
        ASSERT_TRUE(reading.shown) << spheres[i].joint;
        EXPECT_STREQ(ColorName(*reading.shown), ColorName(load_class)) << spheres[i].joint;
      }
      EXPECT_GE(readable, 13) << "of 15 in a frontal view";
    }
  }
}

// All of a mixed body, from all sides: hidden joints shine through in their own colour.
TEST(Spheres, MatchTheStateFromEverySide) {
  const auto renderer = MakeRenderer();
  for (const Posture posture : {Posture::kStanding, Posture::kDeepBend, Posture::kArmsForward}) {
    const SceneState state = MixedScene(posture);
    for (const std::string& name : CameraNames()) {
      const Camera camera = NamedCamera(name, state);
      const Image image = renderer->Render(state, camera, PlainView());
      const auto spheres = LocateSpheres(state, camera, kSpheresWidth, kSpheresHeight);
      EXPECT_THAT(FindSphereMismatches(image, spheres), ::testing::IsEmpty()) << name;
    }
  }
}

TEST(Spheres, OfHiddenJointsAreVisibleThroughTheBody) {
  SceneState state = SceneWith(Posture::kStanding, LoadClass::kLow);
  JointLoad& hip = LoadOf(state, urdf::jRightHip);
  hip.load_class = LoadClass::kHigh;
  state.people[0].loads = {hip};  // nothing else may be in the way
  const Camera camera = NamedCamera("left", state);
  const auto renderer = MakeRenderer();
  const Image image = renderer->Render(state, camera, PlainView());
  const auto spheres = LocateSpheres(state, camera, kSpheresWidth, kSpheresHeight);
  EXPECT_EQ(ReadSphere(image, spheres, 0).shown, LoadClass::kHigh);
  // Paler than one that lies open: it must not look nearer than it is.
  const Camera right = NamedCamera("right", state);
  const Image open = renderer->Render(state, right, PlainView());
  const auto red_minus_green = [&](const Image& picture, const Camera& from) {
    const SphereInPicture sphere = LocateSpheres(state, from, kSpheresWidth, kSpheresHeight).at(0);
    const auto at = 4 * (static_cast<std::size_t>(sphere.y_px) * kSpheresWidth +
                         static_cast<std::size_t>(sphere.x_px));
    return picture.rgba[at] - picture.rgba[at + 1];
  };
  EXPECT_GT(red_minus_green(open, right), red_minus_green(image, camera) + 40);
}

TEST(Spheres, OfAnotherStateAreReportedAsMismatches) {
  const SceneState drawn = SceneWith(Posture::kStanding, LoadClass::kMedium);
  SceneState expected = drawn;
  LoadOf(expected, urdf::jRightElbow).load_class = LoadClass::kLow;
  const Camera camera = NamedCamera("front", drawn);
  const Image image = MakeRenderer()->Render(drawn, camera, PlainView());
  EXPECT_THAT(
      FindSphereMismatches(image, LocateSpheres(expected, camera, kSpheresWidth, kSpheresHeight)),
      ::testing::ElementsAre("right_elbow shows orange, expected green"));
}

TEST(Spheres, AreMissingInABlankPicture) {
  const SceneState state = SceneWith(Posture::kStanding, LoadClass::kHigh);
  const Camera camera = NamedCamera("front", state);
  Image blank{kSpheresWidth, kSpheresHeight,
              std::vector<std::uint8_t>(std::size_t{4} * kSpheresWidth * kSpheresHeight, 240)};
  EXPECT_GE(FindSphereMismatches(blank, LocateSpheres(state, camera, kSpheresWidth, kSpheresHeight))
                .size(),
            13u);
}

TEST(Spheres, HaveADarkRimInTheHighClassForColourBlindViewers) {
  const auto renderer = MakeRenderer();
  const auto rim_brightness = [&](LoadClass load_class) {
    const SceneState state = SceneWith(Posture::kStanding, load_class);
    const Camera camera = NamedCamera("front", state);
    const Image image = renderer->Render(state, camera, PlainView(2));
    const auto spheres = LocateSpheres(state, camera, kSpheresWidth, kSpheresHeight);
    const SphereInPicture& knee = Find(spheres, "right_knee");
    double sum = 0;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2 * M_PI * i / 24;
      const auto x = static_cast<std::size_t>(knee.x_px + 0.88 * knee.radius_px * std::cos(angle));
      const auto y = static_cast<std::size_t>(knee.y_px + 0.88 * knee.radius_px * std::sin(angle));
      const std::size_t at = 4 * (y * kSpheresWidth + x);
      sum += std::max({image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]});
    }
    return sum / 24;
  };
  EXPECT_LT(rim_brightness(LoadClass::kHigh), 90);
  EXPECT_GT(rim_brightness(LoadClass::kMedium), 130);
}

TEST(Spheres, OutsideThePictureOrBehindTheCameraAreNotRead) {
  SceneState state = SceneWith(Posture::kStanding);
  Camera camera;
  camera.position = {3, 0, 1};
  camera.target = {6, 0, 1};  // turned away from the person
  const Image blank{64, 64, std::vector<std::uint8_t>(4 * 64 * 64, 255)};
  for (const SphereInPicture& sphere : LocateSpheres(state, camera, 64, 64)) {
    EXPECT_LE(sphere.depth_m, 0);
  }
  EXPECT_THAT(FindSphereMismatches(blank, LocateSpheres(state, camera, 64, 64)),
              ::testing::IsEmpty());
  state.people[0].loads[0].position.x() = std::numeric_limits<double>::quiet_NaN();
  camera.target = {0, 0, 1};
  const auto spheres = LocateSpheres(state, camera, 64, 64);
  EXPECT_FALSE(ReadSphere(blank, spheres, 0).is_readable);
}

}  // namespace
}  // namespace kinescope::render
