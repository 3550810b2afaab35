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

PictureSpec OfSize(int width, int height) {
  PictureSpec spec;
  spec.width = width;
  spec.height = height;
  return spec;
}

// The floor is kept from the second picture of a camera on.
void RenderThrice(Renderer& renderer, const PictureSpec& spec) {
  for (const Posture posture : {Posture::kStanding, Posture::kStanding, Posture::kDeepBend}) {
    renderer.Render(MixedScene(posture), FrontCamera(), spec);
  }
}

TEST(RegionDrawing, FindsAnActorThatIsOutsideOfItsPart) {
  RegionSettings regions;
  regions.check_every = 1;
  RenderThrice(*With(regions), OfSize(320, 320));
  regions.margin_px = -60;
  try {
    RenderThrice(*With(regions), OfSize(320, 320));
    FAIL() << "nothing was found";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("person 0"));
  }
}

TEST(RegionDrawing, LeavesNothingOfThePictureBefore) {
  const PictureSpec spec = OfSize(333, 250);
  SceneState empty;
  empty.liveness = Liveness::kLive;
  const auto renderer = With({});
  RenderThrice(*renderer, spec);
  const Image floor = MakeRenderer()->Render(empty, FrontCamera(), spec);
  EXPECT_TRUE(Compare(floor, renderer->Render(empty, FrontCamera(), spec)).equal());
}

}  // namespace
}  // namespace kinescope::render
