// What a picture shows with several views, and what is written over it as vectors.
#include "render/multi_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "render/camera/spheres.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

PictureSpec Small() {
  PictureSpec spec;
  spec.width = 321;
  spec.height = 180;
  spec.overlays = false;
  return spec;
}

TEST(MultiView, ShowsThePictureOfEachCamera) {
  const auto renderer = MakeRenderer();
  const SceneState state = kinescope::testing::MixedScene(kinescope::testing::Posture::kStanding);
  PictureSpec spec = Small();
  for (const char* name : {"front", "top"}) spec.panes.push_back({name, NamedCamera(name, state)});
  spec.pane_columns = 2;
  const Image both = renderer->Render(state, Camera(), spec);
  const auto tiles = PaneTiles(spec.width, spec.height, 2, 2);
  for (std::size_t i = 0; i < tiles.size(); ++i) {
    PictureSpec alone = Small();
    alone.width = tiles[i].width;
    Image expected = both;
    CopyInto(expected, renderer->Render(state, spec.panes[i].camera, alone), tiles[i]);
    EXPECT_EQ(expected.rgba, both.rgba) << spec.panes[i].name;
  }
}

TEST(MultiView, PutsSpheresAtTheirProjectionsWithoutPerspective) {
  const auto renderer = MakeRenderer();
  const SceneState state = kinescope::testing::MixedScene(kinescope::testing::Posture::kStanding);
  const Camera camera = Orthographic(NamedCamera("front", state));
  PictureSpec spec = Small();
  spec.width = 640;
  spec.height = 360;
  const Image image = renderer->Render(state, camera, spec);
  const auto spheres = LocateSpheres(state, camera, spec.width, spec.height);
  EXPECT_TRUE(ReadSphere(image, spheres, 0).is_readable);
  EXPECT_THAT(FindSphereMismatches(image, spheres), ::testing::IsEmpty());
}

TEST(OverlayLayer, HasTheSizeOfThePictureAndIsReproducible) {
  const auto renderer = MakeRenderer();
  const SceneState state = kinescope::testing::MixedScene(kinescope::testing::Posture::kStanding);
  const Camera camera = NamedCamera("front", state);
  PictureSpec spec = Small();
  spec.title = "Ümlaut & <tag>";
  spec.parts.scale = spec.parts.frame_code = true;
  renderer->Render(state, camera, spec);
  spec.overlays = true;
  const std::string svg = renderer->OverlayLayer(state, camera, spec, LayerFormat::kSvg);
  EXPECT_THAT(svg, HasSubstr("width=\"321px\" height=\"180px\""));
  EXPECT_THAT(svg, Not(HasSubstr("<image"))) << "vectors, no pixels";
  const std::string pdf = renderer->OverlayLayer(state, camera, spec, LayerFormat::kPdf);
  EXPECT_THAT(pdf, StartsWith("%PDF-"));
  EXPECT_EQ(renderer->OverlayLayer(state, camera, spec, LayerFormat::kSvg), svg);
  EXPECT_EQ(renderer->OverlayLayer(state, camera, spec, LayerFormat::kPdf), pdf);
  spec.parts.legend = false;
  EXPECT_LT(renderer->OverlayLayer(state, camera, spec, LayerFormat::kSvg).size(), svg.size());
}

}  // namespace
}  // namespace kinescope::render
