// Themes, backgrounds, parts, trails and ghosts, tested by what the picture shows.

#include "render/scene_look.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::MixedScene;
using kinescope::testing::Posture;

constexpr int kLookWidth = 320, kLookHeight = 240;

// Everything that can be switched on is in it.
SceneState FullScene() {
  SceneState state = MixedScene(Posture::kStanding);
  PersonState& person = state.people[0];
  person.forces.support.size = 3;
  person.forces.support.corners[0] = {0.3, 0};
  person.forces.support.corners[1] = {-0.2, 0.3};
  person.forces.support.corners[2] = {-0.2, -0.3};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const urdf::Pose& foot =
        person.links[side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot];
    person.forces.feet[side].force = {20, 0, 400};
    person.forces.feet[side].cop = {foot.position.x() + 0.2, foot.position.y(), 0};
    HandForce& hand = person.forces.hands[side];
    hand.mass_kg = 5;
    hand.grip = hand.point = person.links[urdf::At(urdf::HandSegmentOf(side))].position;
  }
  TrackedObject object;
  object.name = "box";
  object.pose.position = {0.5, 1, 0.5};
  state.objects.push_back(object);
  RobotState robot;
  robot.model = std::make_shared<urdf::RobotModel>(urdf::ParseUrdf(
      "<robot name='r'><link name='a'><visual><geometry><box size='.3 .3 .3'/></geometry></visual>"
      "</link></robot>"));
  robot.world_from_link = {Eigen::Isometry3d(Eigen::Translation3d(0, -1, 0.15))};
  state.robots.push_back(robot);
  auto marker = std::make_shared<SceneMarker>();
  marker->pose.position = {0, -1, 1};
  marker->scale = {0.3, 0.2, 0.1};
  state.markers.push_back(marker);
  return state;
}

PictureSpec LookView(int supersample = 1) {
  PictureSpec spec;
  spec.width = kLookWidth;
  spec.height = kLookHeight;
  spec.supersample = supersample;
  return spec;
}

Camera Front(const SceneState& state) { return NamedCamera("three_quarter", state); }

std::array<int, 3> PixelAt(const Image& image, const Camera& camera, const Eigen::Vector3d& point) {
  const Projected at = Project(point, camera, image.width, image.height);
  const std::size_t first =
      4 * (static_cast<std::size_t>(at.y_px) * static_cast<std::size_t>(image.width) +
           static_cast<std::size_t>(at.x_px));
  return {image.rgba.at(first), image.rgba.at(first + 1), image.rgba.at(first + 2)};
}

class SceneLookDrawing : public ::testing::Test {
 protected:
  Image Draw(const PictureSpec& spec) { return renderer_->Render(state_, camera_, spec); }

  const SceneState state_ = FullScene();
  const Camera camera_ = Front(state_);
  const std::unique_ptr<Renderer> renderer_ = MakeRenderer();
};

TEST_F(SceneLookDrawing, MatchesTheOpaquePictureWhenATransparentOneIsLaidOverWhite) {
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    for (const int supersample : {1, 2, 4}) {
      PictureSpec spec = LookView(supersample);
      spec.look.theme = theme;
      spec.overlays = theme == Theme::kLight;  // texts are those of the theme, or suit white
      spec.look.ghosts.push_back({state_.people[0], 0.4});
      for (urdf::Pose& link : spec.look.ghosts[0].person.links) link.position.y() += 0.4;
      PictureSpec white = spec;
      white.look.background = Rgb{1, 1, 1};
      spec.look.is_transparent = true;
      const Image over = Draw(white), clear = Draw(spec);
      EXPECT_TRUE(over.is_opaque);
      EXPECT_TRUE(IsOpaque(Image{over.width, over.height, over.rgba})) << "searched";
      EXPECT_FALSE(clear.is_opaque);
      int covered = 0, empty = 0, soft = 0, worst = 0;
      for (std::size_t at = 0; at < clear.rgba.size(); at += 4) {
        const int alpha = clear.rgba[at + 3];
        (alpha == 255 ? covered : alpha == 0 ? empty : soft) += 1;
        for (std::size_t i = at; i < at + 3; ++i) {
          // As any viewer does it: rounded to the nearest level.
          const int composed = (clear.rgba[i] * alpha + 255 * (255 - alpha) + 127) / 255;
          worst = std::max(worst, std::abs(composed - over.rgba[i]));
        }
      }
      EXPECT_LE(worst, 1) << "levels, supersample " << supersample;
      EXPECT_GT(covered, 1000);
      EXPECT_GT(empty, 1000);
      EXPECT_GT(soft, 1000) << "floor, shadows, ghost";
    }
  }
}

// For slides of that theme: what is behind it is not known.
TEST_F(SceneLookDrawing, HasTextsOfItsThemeWhereItIsTransparent) {
  for (const Theme theme : {Theme::kLight, Theme::kDark}) {
    PictureSpec spec = LookView();
    spec.width = 640;
    spec.height = 360;
    spec.overlays = true;
    spec.title = "MMMMMMMM";
    spec.look.theme = theme;
    spec.look.is_transparent = true;
    const Image image = Draw(spec);
    int opaque = 0, of_theme = 0;
    for (int y = 8; y < 26; ++y) {  // the title
      for (int x = 8; x < 120; ++x) {
        const std::uint8_t* const pixel = &image.rgba[4 * static_cast<std::size_t>(y * 640 + x)];
        if (pixel[3] < 250) continue;
        ++opaque;
        if ((pixel[1] > 128) == (theme == Theme::kDark)) ++of_theme;
      }
    }
    EXPECT_GT(opaque, 50);
    EXPECT_EQ(of_theme, opaque);
  }
}

TEST_F(SceneLookDrawing, HasTheBackgroundOfTheThemeOrTheRequestedOne) {
  PictureSpec spec = LookView();
  spec.look.floor = false;
  const auto corner = [&](const SceneLook& look) {
    spec.look.theme = look.theme;
    spec.look.background = look.background;
    const Image image = Draw(spec);
    return Rgb{image.rgba[0] / 255.0, image.rgba[1] / 255.0, image.rgba[2] / 255.0};
  };
  SceneLook look;
  const auto expect_near = [](const Rgb& shown, const Rgb& wanted) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(shown[i], wanted[i], 0.5 / 255 + 1e-9);
  };
  expect_near(corner(look), ColorsOf(Theme::kLight).background);
  look.theme = Theme::kDark;
  expect_near(corner(look), ColorsOf(Theme::kDark).background);
  look.background = Rgb{0.2, 0.4, 0.6};
  expect_near(corner(look), *look.background);
}

TEST_F(SceneLookDrawing, CanHideEveryElement) {
  const PictureSpec standard = LookView();
  const Image shown = Draw(standard);
  for (const ScenePartInfo& info : kSceneParts) {
    PictureSpec spec = standard;
    spec.look.shown.Set(info.part, !info.by_default);
    EXPECT_GT(Compare(shown, Draw(spec)).pixels, 20) << info.name;
  }
  PictureSpec bare = standard;
  bare.look.floor = false;
  EXPECT_GT(Compare(shown, Draw(bare)).pixels, 5000) << "floor";
  // And nothing of it stays behind in the renderer.
  EXPECT_EQ(Draw(standard).rgba, shown.rgba);
  EXPECT_EQ(Draw(standard).rgba, shown.rgba) << "floor from memory";
}

TEST_F(SceneLookDrawing, ShowsNoArrowForAnUnknownForce) {
  PictureSpec without = LookView();
  without.look.shown.Set(ScenePart::kForces, false);
  SceneState unknown = state_;
  for (FootForce& foot : unknown.people[0].forces.feet) {
    foot.force.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  EXPECT_EQ(renderer_->Render(unknown, camera_, LookView()).rgba, Draw(without).rgba);
}

TEST_F(SceneLookDrawing, ShowsAThousandNewtonsAsAnArrowOfOneMetre) {
  SceneState state = state_;
  PersonState& person = state.people[0];
  person.forces.feet[urdf::kLeft].force.setZero();
  FootForce& foot = person.forces.feet[urdf::kRight];
  foot.cop = {0, -1.2, 0};  // away from everything else
  foot.force = {0, 0, 800};
  PictureSpec bare = LookView(2);
  bare.overlays = false;  // the legend would cover it
  const auto reaches = [&](double height) {
    const Eigen::Vector3d point = foot.cop + Eigen::Vector3d(0, 0, height);
    const auto pixel = PixelAt(renderer_->Render(state, camera_, bare), camera_, point);
    return pixel[2] - pixel[0] > 60;  // blue
  };
  state.robots.clear();
  state.markers.clear();
  EXPECT_TRUE(reaches(0.76));
  EXPECT_FALSE(reaches(0.84));
}

TEST_F(SceneLookDrawing, ShowsTrailsAndReferencePosesAtTheirPlaces) {
  PictureSpec spec = LookView();
  spec.overlays = false;
  const Image before = Draw(spec);
  const Eigen::Vector3d from(0.2, 0.8, 1.4), to(0.2, 1.2, 1.8);
  spec.look.trails.push_back({{from, 0.5 * (from + to), to}, {0, 0, 1}});
  spec.look.trails.push_back({{from}, {0, 0, 1}});  // one point is no line
  const Image after = Draw(spec);
  EXPECT_GT(PixelAt(after, camera_, 0.25 * from + 0.75 * to)[2],
            PixelAt(after, camera_, 0.25 * from + 0.75 * to)[0] + 60);
  EXPECT_LT(Compare(before, after).pixels, 200) << "a thin line";
  spec.look.trails.clear();
  spec.look.ghosts.push_back({state_.people[0], 0.5});
  for (urdf::Pose& link : spec.look.ghosts[0].person.links) link.position.y() += 0.9;
  const Eigen::Vector3d chest = spec.look.ghosts[0].person.links[urdf::kT8].position;
  const Image ghost = Draw(spec);
  spec.look.ghosts[0].opacity = 1;
  const Image solid = Draw(spec);
  const int behind = PixelAt(before, camera_, chest)[0],
            through = PixelAt(ghost, camera_, chest)[0], full = PixelAt(solid, camera_, chest)[0];
  EXPECT_NEAR(through, 0.5 * (behind + full), 2);
}

}  // namespace
}  // namespace kinescope::render
