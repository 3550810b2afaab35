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
  constexpr int kViews = 4, kPictures = 6, kLargest = 320;
  RandomScenes scenes(1);
  std::array<Image, 2> drawn;  // in turns, as those of a clip: what they have already stays
  for (int i = 0; i < kViews; ++i) {
    RandomScenes::View view = scenes.NextView(kLargest);
    for (int picture = 0; picture < kPictures; ++picture) {
      const SceneState state = scenes.NextState(view.spec.look);
      const Image expected = whole->Render(state, view.camera, view.spec);
      Image& image = drawn.at(static_cast<std::size_t>(picture % 2));
      parts->RenderInto(image, state, view.camera, view.spec);
      ASSERT_TRUE(Compare(expected, image).equal()) << "view " << i << ", picture " << picture;
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

std::vector<PictureSpec> TiledAndOtherSizes() {
  PictureSpec wide = OfSize(1100, 40);  // drawn as tiles of 1024 and 76 px
  wide.supersample = 4;
  PictureSpec high = OfSize(40, 2100);
  high.supersample = 2;
  // The same pixels drawn, in other pictures.
  PictureSpec small = OfSize(160, 90), large = OfSize(320, 180);
  small.supersample = 2;
  PictureSpec views = OfSize(321, 240);  // of unequal size
  for (const char* name : {"front", "left", "top"}) {
    views.panes.push_back({name, NamedCamera(name, MixedScene(Posture::kStanding))});
  }
  views.pane_columns = 2;
  return {wide, large, small, views, high};
}

TEST(RegionDrawing, IsTheSameInTilesViewsAndAllSizesInTurn) {
  RegionSettings off;
  off.is_off = true;
  const auto parts = With({});
  for (int round = 0; round < 2; ++round) {
    for (const PictureSpec& spec : TiledAndOtherSizes()) {
      RenderThrice(*parts, spec);
      const SceneState state = MixedScene(Posture::kArmsForward);
      const Image expected = With(off)->Render(state, FrontCamera(), spec);
      EXPECT_TRUE(Compare(expected, parts->Render(state, FrontCamera(), spec)).equal())
          << spec.width << " x " << spec.height << " px, round " << round;
    }
  }
}

}  // namespace
}  // namespace kinescope::render
