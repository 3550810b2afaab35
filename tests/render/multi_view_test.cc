// What a picture shows with several views, and what is written over it as vectors.
#include "render/multi_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/renderer.h"
#include "render/spheres.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

View Small() {
  View view;
  view.width = 321;
  view.height = 180;
  view.overlays = false;
  return view;
}

TEST(MultiView, EachViewIsThePictureOfItsCamera) {
  const auto renderer = MakeRenderer();
  const SceneState state = kinescope::testing::MixedScene(kinescope::testing::Posture::kStanding);
  View view = Small();
  for (const char* name : {"front", "top"}) view.panes.push_back({name, NamedCamera(name, state)});
  view.pane_columns = 2;
  const Image both = renderer->Render(state, Camera(), view);
  const auto tiles = PaneTiles(view.width, view.height, 2, 2);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    View alone = Small();
    alone.width = tiles[i].width;
    Image expected = both;
    CopyInto(expected, renderer->Render(state, view.panes[i].camera, alone), tiles[i]);
    EXPECT_EQ(expected.rgba, both.rgba) << view.panes[i].name;
  }
}

TEST(MultiView, WithoutPerspectiveSpheresAreWhereTheCameraSays) {
  const auto renderer = MakeRenderer();
  const SceneState state = kinescope::testing::MixedScene(kinescope::testing::Posture::kStanding);
  const Camera camera = Orthographic(NamedCamera("front", state));
  View view = Small();
  view.width = 640;
  view.height = 360;
  const Image image = renderer->Render(state, camera, view);
  const auto spheres = LocateSpheres(state, camera, view.width, view.height);
  EXPECT_TRUE(ReadSphere(image, spheres, 0).is_readable);
  EXPECT_THAT(FindSphereMismatches(image, spheres), ::testing::IsEmpty());
}

TEST(OverlayLayer, IsAsLargeAsThePictureAndTheSameEveryTime) {
  const auto renderer = MakeRenderer();
  const SceneState state = kinescope::testing::MixedScene(kinescope::testing::Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  View view = Small();
  view.title = "Ümlaut & <tag>";
  view.parts.scale = view.parts.frame_code = true;
  renderer->Render(state, camera, view);
  const std::string svg = renderer->OverlayLayer(state, camera, view, LayerFormat::kSvg);
  EXPECT_THAT(svg, HasSubstr("width=\"321px\" height=\"180px\""));
  EXPECT_THAT(svg, Not(HasSubstr("<image"))) << "vectors, no pixels";
  const std::string pdf = renderer->OverlayLayer(state, camera, view, LayerFormat::kPdf);
  EXPECT_THAT(pdf, StartsWith("%PDF-"));
  EXPECT_EQ(renderer->OverlayLayer(state, camera, view, LayerFormat::kSvg), svg);
  EXPECT_EQ(renderer->OverlayLayer(state, camera, view, LayerFormat::kPdf), pdf);
  view.parts.legend = false;
  EXPECT_LT(renderer->OverlayLayer(state, camera, view, LayerFormat::kSvg).size(), svg.size());
}

}  // namespace
}  // namespace kinescope::render
