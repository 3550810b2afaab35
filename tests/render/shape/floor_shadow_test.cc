#include "render/shape/floor_shadow.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

namespace kinescope::render {
namespace {

constexpr Rgb kShadowColor = {0.1, 0.1, 0.2};
constexpr int kWidth = 333, kHeight = 187;

// A trunk that stands at `x`, `y`, and nothing else.
skin::Capsules TrunkAt(float x, float y) {
  skin::Capsules limbs;
  limbs.fill({{x, y, 0.8f}, {x, y, 0.8f}, 0.001f, 0.001f});
  limbs.front() = {{x, y, 0.1f}, {x, y, 1.5f}, 0.12f, 0.12f};
  return limbs;
}

Image Floor() {
  Image image;
  SetSize(image, kWidth, kHeight);
  std::fill(image.rgba.begin(), image.rgba.end(), std::uint8_t{230});
  return image;
}

std::size_t PixelAt(const Eigen::Vector3d& point, const Camera& camera) {
  const Projected at = Project(point, camera, kWidth, kHeight);
  return 4 * (static_cast<std::size_t>(at.y_px) * kWidth + static_cast<std::size_t>(at.x_px));
}

TEST(FloorShadow, IsDarkestUnderThePersonAndEndsBesideThem) {
  FloorShadow shadow;
  shadow.Cast(TrunkAt(0.5f, 0.25f));
  const Camera camera = NamedCamera("top", SceneState());
  const Image floor = Floor();
  Image image = floor;
  shadow.BlendInto(image, {0, 0, kWidth, kHeight}, camera, kShadowColor);
  const auto left = [&](double x, double y) {  // of the floor's light
    const std::size_t at = PixelAt({x, y, 0.002}, camera);
    EXPECT_EQ(image.rgba[at + 3], floor.rgba[at + 3]);
    return static_cast<double>(image.rgba[at]) / floor.rgba[at];
  };
  EXPECT_LT(left(0.5, 0.25), 0.5);
  EXPECT_LT(left(0.5, 0.25), left(0.7, 0.25) - 0.1);
  EXPECT_LT(left(0.7, 0.25), left(0.85, 0.25));
  EXPECT_LT(left(0.8, 0.25), 1);
  EXPECT_EQ(left(1.0, 0.25), 1);
  EXPECT_EQ(left(0.5, -0.3), 1);
}

TEST(FloorShadow, HasTheOutlineOfThePerson) {
  FloorShadow shadow;
  shadow.Cast(TrunkAt(0, 0));
  const Camera camera = NamedCamera("top", SceneState());
  Image image = Floor();
  shadow.BlendInto(image, {0, 0, kWidth, kHeight}, camera, kShadowColor);
  const auto level = [&](double x, double y) {
    return static_cast<int>(image.rgba[PixelAt({x, y, 0.002}, camera)]);
  };
  for (const double radius : {0.15, 0.2, 0.25, 0.3}) {  // m
    const double diagonal = radius / std::sqrt(2.0);
    EXPECT_LT(level(radius, 0), Floor().rgba.front());
    EXPECT_NEAR(level(radius, 0), level(diagonal, diagonal), 4) << radius;
  }
  EXPECT_EQ(level(0.4, 0.4), Floor().rgba.front());
}

TEST(FloorShadow, IsTheSameInTiles) {
  FloorShadow shadow;
  shadow.Cast(TrunkAt(0, 0));
  for (const std::string& name : CameraNames()) {
    for (Camera camera : {NamedCamera(name, SceneState()), Camera()}) {
      if (name == "left") {  // from within the shadow: the horizon runs through it
        camera.position = {0.3, 0.1, 0.05};
        camera.target = {-2, 0, 0.05};
      }
      Image whole = Floor(), tiled = whole;
      shadow.BlendInto(whole, {0, 0, kWidth, kHeight}, camera, kShadowColor);
      for (int y = 0; y < kHeight; y += 50) {
        for (int x = 0; x < kWidth; x += 71) {
          const Tile tile{x, y, std::min(71, kWidth - x), std::min(50, kHeight - y)};
          shadow.BlendInto(tiled, tile, camera, kShadowColor);
        }
      }
      EXPECT_TRUE(whole.rgba == tiled.rgba) << name;
      EXPECT_FALSE(whole.rgba == Floor().rgba) << name;
    }
  }
}

TEST(FloorShadow, IsNotSeenFromBelow) {
  FloorShadow shadow;
  shadow.Cast(TrunkAt(0, 0));
  Camera below;
  below.position = {2, 0, -1};
  below.target = {0, 0, 0};
  Image image = Floor();
  shadow.BlendInto(image, {0, 0, kWidth, kHeight}, below, kShadowColor);
  EXPECT_TRUE(image.rgba == Floor().rgba);
}

}  // namespace
}  // namespace kinescope::render
