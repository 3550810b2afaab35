// Pictures of which only a part is drawn have the bytes of those that are drawn whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/random_scenes.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::FrontCamera;
using kinescope::testing::MixedScene;
using kinescope::testing::Posture;
using kinescope::testing::RandomScenes;

std::unique_ptr<Renderer> With(const RegionSettings& regions) {
  RendererSettings settings;
  settings.regions = regions;
  settings.log = [](const std::string&) {};
  return MakeRenderer(std::move(settings));
}

TEST(RegionDrawing, GivesTheBytesOfWholePictures) {
  RegionSettings off;
  off.is_off = true;
  const auto whole = With(off), parts = With({});
  constexpr int kViews = 4, kPictures = 4, kLargest = 320;
  RandomScenes scenes(1);
  for (int i = 0; i < kViews; ++i) {
    RandomScenes::View view = scenes.NextView(kLargest);
    for (int picture = 0; picture < kPictures; ++picture) {
      const SceneState state = scenes.NextState(view.spec.look);
      const Image expected = whole->Render(state, view.camera, view.spec);
      ASSERT_TRUE(Compare(expected, parts->Render(state, view.camera, view.spec)).equal())
          << "view " << i << ", picture " << picture;
    }
  }
}

// The third picture of a camera is the first with the floor of before.
std::unique_ptr<Renderer> AfterTwoPictures(const RegionSettings& regions, const PictureSpec& spec) {
  auto renderer = With(regions);
  for (int i = 0; i < 2; ++i) {
    renderer->Render(MixedScene(Posture::kStanding), FrontCamera(), spec);
  }
  return renderer;
}

TEST(RegionDrawing, FindsAnActorThatIsOutsideOfItsPart) {
  PictureSpec spec;
  spec.width = spec.height = 320;
  RegionSettings regions;
  regions.check_every = 1;
  const SceneState state = MixedScene(Posture::kDeepBend);
  AfterTwoPictures(regions, spec)->Render(state, FrontCamera(), spec);
  regions.margin_px = -60;
  const auto renderer = AfterTwoPictures(regions, spec);
  try {
    renderer->Render(state, FrontCamera(), spec);
    FAIL() << "nothing was found";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("person 0"));
  }
}

TEST(RegionDrawing, LeavesNothingOfThePictureBefore) {
  PictureSpec spec;
  spec.width = 333;
  spec.height = 250;
  SceneState nobody;
  nobody.liveness = Liveness::kLive;
  const auto renderer = AfterTwoPictures({}, spec);
  const Image floor = MakeRenderer()->Render(nobody, FrontCamera(), spec);
  EXPECT_TRUE(Compare(floor, renderer->Render(nobody, FrontCamera(), spec)).equal());
}

}  // namespace
}  // namespace kinescope::render
