// Pictures of which only a part is drawn have the bytes of those that are drawn whole.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

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

std::unique_ptr<Renderer> RendererWith(const RegionSettings& regions) {
  RendererSettings settings;
  settings.regions = regions;
  settings.log = [](const std::string&) {};
  // The first picture of a group makes a skin for each of them: half a minute of sanitized code.
  settings.limit = std::chrono::minutes(10);
  return MakeRenderer(std::move(settings));
}

std::unique_ptr<Renderer> Whole() {
  RegionSettings off;
  off.is_off = true;
  return RendererWith(off);
}

TEST(RegionDrawing, GivesTheBytesOfWholePictures) {
  const auto whole = Whole(), parts = RendererWith({});
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
  RenderThrice(*RendererWith(regions), OfSize(320, 320));
  regions.margin_px = -60;
  try {
    RenderThrice(*RendererWith(regions), OfSize(320, 320));
    FAIL() << "nothing was found";
  } catch (const RenderError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("person 0"));
  }
}

TEST(RegionDrawing, LeavesNothingOfThePictureBefore) {
  const PictureSpec spec = OfSize(333, 250);
  SceneState empty;
  empty.liveness = Liveness::kLive;
  const auto renderer = RendererWith({});
  RenderThrice(*renderer, spec);
  const Image floor = MakeRenderer()->Render(empty, FrontCamera(), spec);
  EXPECT_TRUE(Compare(floor, renderer->Render(empty, FrontCamera(), spec)).equal());
}

struct Extreme {
  std::string name;
  SceneState state = MixedScene(Posture::kStanding);
  PictureSpec spec = OfSize(333, 250);
  Camera camera = FrontCamera();
};

std::shared_ptr<const SceneMarker> MarkerOf(MarkerType type, const Eigen::Vector3d& scale,
                                            const Eigen::Vector3d& position) {
  SceneMarker marker;
  marker.type = type;
  if (type == MarkerType::kText) {
    marker.text = "a label that runs out of the picture on both of its sides, and on";
  }
  marker.scale = scale;
  marker.pose.position = position;
  marker.color = {0.2, 0.5, 0.9, 0.6};
  return std::make_shared<const SceneMarker>(marker);
}

// In pixels; also at the edges of the picture and beyond them.
std::shared_ptr<const SceneMarker> WidePoints() {
  SceneMarker marker;
  marker.type = MarkerType::kPoints;
  marker.scale = {50, 30, 0};
  marker.is_in_pixels = true;
  for (const double y : {-3.0, -2.0, -1.5, 0.0, 1.5, 2.0, 3.0}) {
    marker.points.emplace_back(0, y, 1.1);
    marker.points.emplace_back(-20, 5 * y, 1.1);
  }
  marker.color = {0.2, 0.5, 0.9, 1};
  return std::make_shared<const SceneMarker>(marker);
}

std::vector<Extreme> Extremes() {
  std::vector<Extreme> all;
  const auto add = [&](const char* name) -> Extreme& {
    all.push_back({});
    all.back().name = name;
    return all.back();
  };
  using Eigen::Vector3d;
  add("a marker of the size of the world").state.markers = {
      MarkerOf(MarkerType::kSphere, Vector3d::Constant(1e4), Vector3d::Zero())};
  add("a marker larger than floats like").state.markers = {
      MarkerOf(MarkerType::kCube, Vector3d::Constant(1e12), Vector3d(5e11, 0, 0))};
  add("a marker on the camera").state.markers = {
      MarkerOf(MarkerType::kCube, Vector3d::Constant(0.5), FrontCamera().position)};
  add("a label that runs out of the picture").state.markers = {
      MarkerOf(MarkerType::kText, Vector3d(0, 0, 0.3), Vector3d(0, 1.2, 1)),
      MarkerOf(MarkerType::kText, Vector3d(0, 0, 40), Vector3d(-3, 0, 1))};
  add("points in pixels").state.markers = {WidePoints()};
  Trail hour{{}, {0.1, 0.4, 0.7}, "hand"};
  for (int i = 0; i < 3600; ++i) {
    const double t = i;
    hour.points.emplace_back(2 * std::cos(0.01 * t), 2 * std::sin(0.013 * t), 1 + std::sin(t));
  }
  add("a trail of an hour").spec.look.trails = {hour};
  Extreme& far = add("people at the far plane and behind the camera");
  for (const Vector3d& by : {Vector3d(-95, 3, 0), Vector3d(-4000, 0, 0), Vector3d(60, 0, 0)}) {
    PersonState person = MixedScene(Posture::kDeepBend).people[0];
    person.character = static_cast<int>(far.state.people.size());
    for (urdf::Pose& pose : person.links) pose.position += by;
    for (JointLoad& load : person.loads) load.position += by;
    far.state.people.push_back(std::move(person));
  }
  add("a region larger than the picture").camera.vertical_fov_rad = 0.02;
  add("the smallest picture").spec = OfSize(kMinPictureSide, kMinPictureSide);
  add("not a multiple of 16, odd").spec = OfSize(271, 163);
  const std::size_t count = all.size();
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back(all[i]);
    all[i].spec.overlays = false;
    all.back().spec.supersample = 2;
  }
  return all;
}

TEST(RegionDrawing, GivesTheBytesOfWholePicturesOfWhatIsNotOrdinary) {
  const auto whole = Whole(), parts = RendererWith({});
  Image image;
  for (Extreme& extreme : Extremes()) {
    PictureSpec calm_spec = extreme.spec;
    calm_spec.look.trails.clear();
    const SceneState calm = MixedScene(Posture::kDeepBend);
    for (int picture = 0; picture < 4; ++picture) {  // it comes and goes
      const bool is_calm = picture % 2 == 1;
      const SceneState& state = is_calm ? calm : extreme.state;
      const PictureSpec& spec = is_calm ? calm_spec : extreme.spec;
      parts->RenderInto(image, state, extreme.camera, spec);
      const Image expected = whole->Render(state, extreme.camera, spec);
      ASSERT_TRUE(Compare(expected, image).equal())
          << extreme.name << ", " << spec.supersample << "x, picture " << picture;
    }
  }
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
  const auto parts = RendererWith({});
  for (int round = 0; round < 2; ++round) {
    for (const PictureSpec& spec : TiledAndOtherSizes()) {
      RenderThrice(*parts, spec);
      const SceneState state = MixedScene(Posture::kArmsForward);
      const Image expected = Whole()->Render(state, FrontCamera(), spec);
      EXPECT_TRUE(Compare(expected, parts->Render(state, FrontCamera(), spec)).equal())
          << spec.width << " x " << spec.height << " px, round " << round;
    }
  }
}

}  // namespace
}  // namespace kinescope::render
