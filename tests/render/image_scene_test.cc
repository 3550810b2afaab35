// The scene over an image of a camera, in a picture of the scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>

#include "render/camera/image_view.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using testing::MixedScene;
using testing::Posture;

constexpr std::array<int, 3> kMagenta = {255, 0, 255};  // nothing of a picture has it

// In front of the person, who faces it; its axis is beside the middle.
ImageCamera InFrontOfPerson(double scene_opacity) {
  ImageCamera camera;
  camera.world_from_optical.position = {3.2, 0.1, 1};
  Eigen::Matrix3d axes;  // looks along -x: its x is the world's y, its y the world's -z
  axes << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  camera.world_from_optical.orientation = Eigen::Quaterniond(axes);
  camera.width = 320;
  camera.height = 240;
  camera.focal_px = {260, 260};
  camera.center_px = {140, 125};
  camera.scene_opacity = scene_opacity;
  return camera;
}

SceneState WithImage(SceneState state, const std::optional<ImageCamera>& camera) {
  auto image = std::make_shared<CameraImage>();
  image->name = "lab";
  image->width = 320;
  image->height = 240;
  image->encoding = "rgb8";
  image->row_bytes = std::size_t{3} * 320;
  image->size = image->row_bytes * 240;
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(image->size);
  for (std::size_t i = 0; i < bytes->size(); ++i) {
    (*bytes)[i] = static_cast<std::uint8_t>(kMagenta[i % 3]);
  }
  image->bytes = bytes;
  image->camera = camera;
  state.images = {image};
  return state;
}

std::array<int, 3> PixelAt(const Image& image, int x, int y) {
  const std::size_t at = 4 * static_cast<std::size_t>(y * image.width + x);
  return {image.rgba[at], image.rgba[at + 1], image.rgba[at + 2]};
}

int DifferenceOf(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  int largest = 0;
  for (std::size_t i = 0; i < 3; ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

// Where the image is: all of it is magenta but for its name, which is in its lower left corner.
Tile PlaceOfImage(const Image& picture) {
  Tile place;
  for (int y = 0; y < picture.height; ++y) {
    for (int x = 0; x < picture.width; ++x) {
      if (DifferenceOf(PixelAt(picture, x, y), kMagenta) > 2) continue;
      if (IsEmpty(place)) place = {x, y, 1, 1};
      const int left = std::min(place.x, x);
      place = {left, place.y, std::max(place.x + place.width, x + 1) - left, y + 1 - place.y};
    }
  }
  return place;
}

TEST(ImageScene, IsWhatTheCameraSees) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kArmsForward);
  PictureSpec spec;
  spec.width = 1280;
  spec.height = 720;
  const auto draw = [&](const std::optional<ImageCamera>& camera) {
    return renderer->Render(WithImage(state, camera), NamedCamera("front", state), spec);
  };
  const Image without = draw(std::nullopt), with = draw(InFrontOfPerson(1)),
              half = draw(InFrontOfPerson(0.5));
  const Tile place = PlaceOfImage(without);
  ASSERT_GT(place.width, 200);

  // The same, drawn by itself.
  const ImageView view = ViewOf(InFrontOfPerson(1), place.width, place.height);
  PictureSpec alone;
  alone.width = view.width;
  alone.height = view.height;
  alone.overlays = false;
  alone.look.floor = false;
  alone.look.shown.Set(ScenePart::kShadows, false);
  alone.look.background = Rgb{1, 0, 1};
  const Image seen = renderer->Render(state, view.camera, alone);

  int of_scene = 0, wrong = 0, wrong_half = 0;
  for (int y = 0; y < place.height - 30; ++y) {  // above the name
    for (int x = 0; x < place.width; ++x) {
      const auto expected = PixelAt(seen, view.image.x + x, view.image.y + y);
      const auto at = PixelAt(with, place.x + x, place.y + y);
      if (DifferenceOf(expected, kMagenta) > 8) ++of_scene;
      if (DifferenceOf(expected, at) > 3) ++wrong;
      std::array<int, 3> blended{};
      for (std::size_t i = 0; i < 3; ++i) blended[i] = (kMagenta[i] + expected[i]) / 2;
      if (DifferenceOf(blended, PixelAt(half, place.x + x, place.y + y)) > 3) ++wrong_half;
    }
  }
  EXPECT_GT(of_scene, 2'000);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(wrong_half, 0);
  // Around the image nothing is different.
  for (int y = 0; y < with.height; ++y) {
    for (int x = 0; x < place.x - 2; ++x) {
      ASSERT_EQ(PixelAt(with, x, y), PixelAt(without, x, y)) << x << ", " << y;
    }
  }
}

TEST(ImageScene, MayBeALargePartOfThePicture) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kStanding);
  PictureSpec spec;
  spec.width = 1280;
  spec.height = 720;
  const auto place_of = [&](double share) {
    SceneState with = WithImage(state, std::nullopt);
    auto image = std::make_shared<CameraImage>(*with.images[0]);
    image->pane_width = share;
    with.images = {image};
    return PlaceOfImage(renderer->Render(with, NamedCamera("front", state), spec));
  };
  EXPECT_NEAR(place_of(0).width, 0.22 * 1280, 2);
  EXPECT_NEAR(place_of(0.5).width, 0.5 * 1280, 2);
  EXPECT_NEAR(place_of(0.5).height, 0.375 * 1280, 2);
  const Tile largest = place_of(1);  // as high as there is room
  EXPECT_GT(largest.width, 700);
  EXPECT_LT(largest.height, 0.85 * 720);
}

TEST(ImageScene, IsWithoutWhatIsHidden) {
  const auto renderer = MakeRenderer();
  const SceneState state = MixedScene(Posture::kStanding);
  PictureSpec spec;
  spec.look.shown = ScenePartSet();
  for (const ScenePartInfo& info : kSceneParts) spec.look.shown.Set(info.part, false);
  const auto draw = [&](const std::optional<ImageCamera>& camera) {
    return renderer->Render(WithImage(state, camera), NamedCamera("front", state), spec);
  };
  EXPECT_EQ(draw(InFrontOfPerson(1)).rgba, draw(std::nullopt).rgba);
}

}  // namespace
}  // namespace kinescope::render
