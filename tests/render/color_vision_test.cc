// Whoever lacks one kind of cones must still tell the load classes apart.

#include "tests/color_vision.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "render/camera/spheres.h"
#include "render/legend.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::ColorVisions;
using kinescope::testing::SeenBy;

constexpr double kMinDifference = 15;  // CIEDE2000

constexpr LoadClass kClasses[] = {LoadClass::kUnknown, LoadClass::kLow, LoadClass::kMedium,
                                  LoadClass::kHigh};

void ExpectApart(const std::map<LoadClass, Rgb>& colors, const char* where) {
  for (const auto& vision : ColorVisions()) {
    for (const auto& [one, color] : colors) {
      for (const auto& [other, other_color] : colors) {
        if (other <= one) continue;
        EXPECT_GE(ColorDifference(SeenBy(vision, color), SeenBy(vision, other_color)),
                  kMinDifference)
            << where << ": " << Name(one) << " and " << Name(other) << " with " << vision.name;
      }
    }
  }
}

// Mean of what the picture shows inside a sphere's rim.
Rgb ShownIn(const Image& image, const SphereInPicture& sphere) {
  Rgb sum = {0, 0, 0};
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      if (std::hypot(x + 0.5 - sphere.x_px, y + 0.5 - sphere.y_px) > 0.6 * sphere.radius_px)
        continue;
      const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
      for (std::size_t i = 0; i < 3; ++i) sum[i] += image.rgba[at + i] / 255.0;
      ++count;
    }
  }
  EXPECT_GT(count, 10);
  for (double& channel : sum) channel /= std::max(count, 1);
  return sum;
}

TEST(ColorVision, DistinguishesTheClassesOfThePalette) {
  std::map<LoadClass, Rgb> colors;
  for (const LoadClass load_class : kClasses) colors[load_class] = ColorOf(load_class);
  ExpectApart(colors, "palette");
}

TEST(ColorVision, DistinguishesTheClassesAsShadedInThePicture) {
  const auto renderer = MakeRenderer();
  PictureSpec spec;
  spec.width = 480;
  spec.height = 360;
  spec.overlays = false;
  for (const char* camera_name : {"front", "top", "left"}) {
    std::map<LoadClass, Rgb> colors;
    for (const LoadClass load_class : kClasses) {
      SceneState state = testing::SceneWith(testing::Posture::kStanding, load_class);
      state.people[0].loads = {testing::LoadOf(state, urdf::jLeftShoulder)};
      const Camera camera = NamedCamera(camera_name, state);
      const Image image = renderer->Render(state, camera, spec);
      colors[load_class] =
          ShownIn(image, LocateSpheres(state, camera, spec.width, spec.height).at(0));
    }
    ExpectApart(colors, camera_name);
  }
}

// In grey print the lightness is left, and the rim.
constexpr double kMinGreyDifference = 10;  // of L*
constexpr double kMinRimDifference = 40;

void ExpectApartInGrey(const std::map<LoadClass, double>& lightness, const char* where) {
  for (const auto& [one, l] : lightness) {
    for (const auto& [other, other_l] : lightness) {
      if (other <= one || RimOf(one) != RimOf(other)) continue;
      EXPECT_GE(std::abs(l - other_l), kMinGreyDifference)
          << where << ": " << Name(one) << " and " << Name(other) << " have the same rim";
    }
  }
}

TEST(GreyPrint, DistinguishesTheClassesOfThePaletteByLightnessOrRim) {
  std::map<LoadClass, double> lightness;
  for (const LoadClass load_class : kClasses) lightness[load_class] = ToLab(ColorOf(load_class)).l;
  ExpectApartInGrey(lightness, "palette");
  EXPECT_NE(RimOf(LoadClass::kHigh), RimOf(LoadClass::kUnknown)) << "whose greys are 6 apart";
  EXPECT_LT(lightness[LoadClass::kHigh], lightness[LoadClass::kLow]);
  EXPECT_LT(lightness[LoadClass::kLow], lightness[LoadClass::kMedium]);
}

// L* of the pixels in a ring of a sphere, from one share of its radius to another: their mean.
double LightnessIn(const Image& image, const SphereInPicture& sphere, double from, double to) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double away =
          std::hypot(x + 0.5 - sphere.x_px, y + 0.5 - sphere.y_px) / sphere.radius_px;
      if (away < from || away > to) continue;
      const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
      sum +=
          ToLab({image.rgba[at] / 255.0, image.rgba[at + 1] / 255.0, image.rgba[at + 2] / 255.0}).l;
      ++count;
    }
  }
  EXPECT_GT(count, 10);
  return sum / std::max(count, 1);
}

TEST(GreyPrint, DistinguishesTheClassesAsShadedInThePicture) {
  const auto renderer = MakeRenderer();
  PictureSpec spec;
  spec.width = 640;
  spec.height = 480;
  spec.overlays = false;
  for (const char* camera_name : {"front", "left"}) {
    std::map<LoadClass, double> lightness, rims;
    for (const LoadClass load_class : kClasses) {
      SceneState state = testing::SceneWith(testing::Posture::kStanding, load_class);
      state.people[0].loads = {testing::LoadOf(state, urdf::jLeftShoulder)};
      const Camera camera = NamedCamera(camera_name, state);
      const Image image = renderer->Render(state, camera, spec);
      const SphereInPicture sphere = LocateSpheres(state, camera, spec.width, spec.height).at(0);
      lightness[load_class] = LightnessIn(image, sphere, 0, 0.6);
      rims[load_class] = LightnessIn(image, sphere, 0.82, 0.94);
    }
    ExpectApartInGrey(lightness, camera_name);
    EXPECT_GE(rims[LoadClass::kUnknown] - rims[LoadClass::kHigh], kMinRimDifference) << camera_name;
    EXPECT_GE(rims[LoadClass::kUnknown] - lightness[LoadClass::kUnknown], kMinGreyDifference);
    EXPECT_GE(lightness[LoadClass::kHigh] - rims[LoadClass::kHigh], kMinGreyDifference);
  }
}

}  // namespace
}  // namespace kinescope::render
