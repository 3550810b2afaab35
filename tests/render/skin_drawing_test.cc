// A person drawn as one skin, tested by what the picture shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/color_difference.h"
#include "core/palette.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"
#include "tests/urdf/rig/rig_samples.h"
#include "tests/urdf/skin_postures.h"
#include "tests/worn.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"

namespace kinescope::render {
namespace {

using kinescope::testing::BodyAlone;
using kinescope::testing::FrontCamera;
using kinescope::testing::Posture;

constexpr int kSquare = 480;

SceneState Person(Posture posture = Posture::kStanding, bool is_built_in = true) {
  SceneState state = BodyAlone(posture);
  PersonState& person = state.people[0];
  auto model = std::make_shared<PersonModel>(*person.model);
  model->has_built_in_surface = is_built_in;
  person.model = model;
  return state;
}

class SkinDrawing : public ::testing::Test {
 protected:
  SkinDrawing() {
    spec_.width = kSquare;
    spec_.height = kSquare;
    spec_.overlays = false;
    spec_.look.figure = Figure::kSkin;
    spec_.look.floor = false;
  }
  Image Draw(const SceneState& state) { return renderer_->Render(state, FrontCamera(), spec_); }

  std::unique_ptr<Renderer> renderer_ = MakeRenderer();
  PictureSpec spec_;
};

TEST_F(SkinDrawing, DrawsTheBuiltInBodyAsASkinAndOthersAsTheirUrdf) {
  const SceneState own = Person(Posture::kStanding, false);
  const Image skin = Draw(Person()), others = Draw(own);
  spec_.look.figure = Figure::kUrdf;
  EXPECT_FALSE(Compare(skin, Draw(Person())).equal());
  EXPECT_TRUE(Compare(others, Draw(own)).equal());
}

TEST_F(SkinDrawing, GivesTheSameBytesWhateverWasDrawnBefore) {
  const Image first = Draw(Person());
  Draw(Person(Posture::kDeepBend));
  EXPECT_TRUE(Compare(first, Draw(Person())).equal());
  EXPECT_TRUE(Compare(first, MakeRenderer()->Render(Person(), FrontCamera(), spec_)).equal());
}

// Where two layers of it were blended, it would be darker.
TEST_F(SkinDrawing, ShowsOneLayerOfAGhost) {
  SceneState without_people;
  without_people.liveness = Liveness::kLive;
  const Image empty = Draw(without_people);
  const auto ghost = [&](double opacity) {
    spec_.look.ghosts = {{Person().people[0], opacity}};
    return Draw(without_people);
  };
  const Image solid = ghost(1), half = ghost(0.5);
  int covered = 0, wrong = 0;
  for (std::size_t i = 0; i < empty.rgba.size(); ++i) {
    if (solid.rgba[i] == empty.rgba[i]) continue;
    ++covered;
    const double expected = 0.5 * (solid.rgba[i] + empty.rgba[i]);
    wrong += std::abs(half.rgba[i] - expected) > 2 ? 1 : 0;
  }
  EXPECT_GT(covered, 10'000);
  EXPECT_LT(wrong, 20) << "but for single pixels of rims";
}

TEST_F(SkinDrawing, MovesTheFingersOfGloves) {
  const auto gloved = [](double bend) {
    SceneState state = Person();
    kinescope::testing::Wear(state.people[0], bend);
    auto model = std::make_shared<PersonModel>(*state.people[0].model);
    model->has_built_in_surface = true;
    state.people[0].model = model;
    return state;
  };
  EXPECT_FALSE(Compare(Draw(gloved(0.1)), Draw(gloved(0.9))).equal());
}

TEST_F(SkinDrawing, DrawsARiggedPersonOfTheUsers) {
  const Image built_in = Draw(Person());
  kinescope::testing::RigSample sample;
  auto own = std::make_shared<skin::SkinTemplate>(
      rig::SkinOf(rig::ReadRig(kinescope::testing::RigGlb(sample))));
  spec_.look.figure.own_skin = own;
  const Image blue = Draw(Person());
  EXPECT_FALSE(Compare(built_in, blue).equal());
  EXPECT_TRUE(Compare(blue, Draw(Person())).equal());
  for (auto& color : own->colors) color = {250, 250, 250, 255};
  spec_.look.figure.own_skin = std::make_shared<skin::SkinTemplate>(*own);
  EXPECT_FALSE(Compare(blue, Draw(Person())).equal()) << "another skin of the same person";
  spec_.look.figure = Figure::kSkin;
  EXPECT_TRUE(Compare(built_in, Draw(Person())).equal());
}

TEST_F(SkinDrawing, HidesTheBodyOnRequest) {
  spec_.look.shown.Set(ScenePart::kBody, false);
  spec_.look.shown.Set(ScenePart::kShadows, false);
  const Image empty = Draw(Person());
  EXPECT_TRUE(Compare(empty, Draw(Person(Posture::kDeepBend))).equal());
}

int CountOf(const Image& image, const Rgb& color, double farthest) {
  int count = 0;
  for (std::size_t i = 0; i + 3 < image.rgba.size(); i += 4) {
    const Rgb pixel = {image.rgba[i] / 255.0, image.rgba[i + 1] / 255.0, image.rgba[i + 2] / 255.0};
    count += ColorDifference(pixel, color) < farthest ? 1 : 0;
  }
  return count;
}

class LoadsOnSkin : public SkinDrawing {
 protected:
  SceneState Loaded(LoadClass load_class) {
    SceneState state = kinescope::testing::SceneWith(Posture::kStanding, load_class);
    auto model = std::make_shared<PersonModel>(*state.people[0].model);
    model->has_built_in_surface = true;
    state.people[0].model = model;
    state.people[0].com.reset();
    state.people[0].cop.reset();
    return state;
  }
  Image DrawWith(LoadsShown loads, const SceneState& state) {
    spec_.look.loads = loads;
    return Draw(state);
  }
};

TEST_F(LoadsOnSkin, AreInTheColourOfTheClassAndLargerForAHigherOne) {
  int smaller = 0;
  for (const LoadClass each : {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh}) {
    const int count = CountOf(DrawWith(LoadsShown::kSkin, Loaded(each)), ColorOf(each), 15);
    EXPECT_GT(count, smaller) << Name(each);
    EXPECT_GT(count, 1500) << Name(each);
    smaller = count;
  }
}

// The large triangles of small pictures would leave notches in their borders.
TEST_F(LoadsOnSkin, HaveTheSameShapeInSmallPictures) {
  const SceneState state = Loaded(LoadClass::kLow);
  const auto share_at = [&](int size) {
    spec_.width = spec_.height = size;
    const int count = CountOf(DrawWith(LoadsShown::kSkin, state), ColorOf(LoadClass::kLow), 15);
    return static_cast<double>(count) / (size * size);
  };
  const double of_large = share_at(960);
  EXPECT_NEAR(share_at(240), of_large, 0.04 * of_large);
}

TEST_F(LoadsOnSkin, AreHatchedWhereTheyAreUnknown) {
  // Every row through a knee has several stripes.
  const Image unknown = DrawWith(LoadsShown::kSkin, Loaded(LoadClass::kUnknown));
  int most = 0;
  for (int y = 0; y < kSquare; ++y) {
    int changes = 0;
    bool was = false;
    for (int x = 0; x < kSquare; ++x) {
      const std::size_t i =
          4 * (static_cast<std::size_t>(y) * kSquare + static_cast<std::size_t>(x));
      const Rgb pixel = {unknown.rgba[i] / 255.0, unknown.rgba[i + 1] / 255.0,
                         unknown.rgba[i + 2] / 255.0};
      const bool is = ColorDifference(pixel, ColorOf(LoadClass::kUnknown)) < 12;
      changes += is != was ? 1 : 0;
      was = is;
    }
    most = std::max(most, changes);
  }
  EXPECT_GE(most, 8);
}

TEST_F(LoadsOnSkin, ReplaceTheSpheresOrStandBesideThem) {
  const SceneState state = Loaded(LoadClass::kHigh);
  const Image spheres = DrawWith(LoadsShown::kSpheres, state);
  const Image both = DrawWith(LoadsShown::kBoth, state), skin = DrawWith(LoadsShown::kSkin, state);
  EXPECT_FALSE(Compare(spheres, both).equal());
  EXPECT_FALSE(Compare(skin, both).equal());
  // Without a skin there are spheres in any case.
  SceneState other = state;
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  model->has_built_in_surface = false;
  other.people[0].model = model;
  EXPECT_TRUE(
      Compare(DrawWith(LoadsShown::kSpheres, other), DrawWith(LoadsShown::kSkin, other)).equal());
}

TEST_F(LoadsOnSkin, AreHiddenOnRequest) {
  spec_.look.shown.Set(ScenePart::kLoads, false);
  const SceneState state = Loaded(LoadClass::kHigh);
  EXPECT_TRUE(
      Compare(DrawWith(LoadsShown::kBoth, state), DrawWith(LoadsShown::kSpheres, state)).equal());
}

TEST_F(SkinDrawing, OfClayHasOneColour) {
  spec_.look.style = Style::kClay;
  SceneState state = Person();
  const Image image = Draw(state);
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  model->suit.trousers = model->suit.top = {0.9, 0.1, 0.1};
  state.people[0].model = model;
  EXPECT_TRUE(Compare(image, Draw(state)).equal());
}

// The outline and nothing else is dark.
TEST_F(SkinDrawing, OfLinesIsAnOutlineOnPaper) {
  spec_.look.style = Style::kLine;
  spec_.look.shown.Set(ScenePart::kShadows, false);
  const Rgb ink = {0.13, 0.15, 0.19};
  const Image image = Draw(Person());
  const int dark = CountOf(image, ink, 25);
  EXPECT_GT(dark, 1000);
  EXPECT_GT(CountOf(image, {1, 1, 1}, 6), 5 * dark);
  spec_.lines = false;
  EXPECT_EQ(CountOf(Draw(Person()), ink, 25), 0);
}

TEST_F(SkinDrawing, OfLinesIsTheSameBesideLargerPicturesAndOtherStyles) {
  spec_.look.style = Style::kLine;
  const Image first = Draw(Person());
  spec_.look.style = Style::kMatte;
  Draw(Person(Posture::kDeepBend));
  spec_.look.style = Style::kLine;
  EXPECT_TRUE(Compare(first, Draw(Person())).equal());
}

TEST_F(SkinDrawing, OfLinesHasThemAsVectors) {
  spec_.look.style = Style::kLine;
  spec_.lines = false;
  spec_.parts = {};
  Draw(Person());
  const std::string lines =
      renderer_->OverlayLayer(Person(), FrontCamera(), spec_, LayerFormat::kSvg);
  spec_.look.style = Style::kMatte;
  Draw(Person());
  const std::string none =
      renderer_->OverlayLayer(Person(), FrontCamera(), spec_, LayerFormat::kSvg);
  const auto paths = [](const std::string& svg) {
    std::size_t count = 0;
    for (std::size_t at = svg.find("<path"); at != std::string::npos;
         at = svg.find("<path", at + 1))
      ++count;
    return count;
  };
  EXPECT_GT(paths(lines), paths(none) + 10);
  EXPECT_LT(lines.size(), 300'000u);
  EXPECT_EQ(lines.find("<image"), std::string::npos);
}

// From the right, at twice the size, so that all strokes have widths of their own.
class Creases : public SkinDrawing {
 protected:
  Creases() {
    spec_.width = spec_.height = 2 * kSquare;
    spec_.look.style = Style::kLine;
    spec_.parts = {};
    camera_.position = {0, -4, 1};
    camera_.target = {0, 0, 1};
  }
  static SceneState WithKneeAt(double degrees) {
    SceneState state = Person();
    urdf::LinkPoses& links = state.people[0].links;
    links = skin::TurnedAt(links, urdf::jRightKnee, Eigen::Vector3d::UnitY(), degrees);
    return state;
  }
  int CountIn(const SceneState& state) {
    renderer_->Render(state, camera_, spec_);
    const std::string layer = renderer_->OverlayLayer(state, camera_, spec_, LayerFormat::kSvg);
    int count = 0;
    for (std::size_t at = 0; (at = layer.find("stroke-width:1.53", at)) != std::string::npos; ++at)
      ++count;
    return count;
  }
  Camera camera_;
};

TEST_F(Creases, AreVectorsWhereTheCalfOfABentKneeMeetsTheThigh) {
  spec_.lines = false;
  const int of_arms = CountIn(WithKneeAt(0));  // which hang beside the trunk
  EXPECT_EQ(CountIn(WithKneeAt(45)), of_arms);
  EXPECT_GT(CountIn(WithKneeAt(140)), of_arms);
}

TEST_F(Creases, AreDrawnInThePicture) {
  const Rgb ink = {0.13, 0.15, 0.19};
  const SceneState state = WithKneeAt(140);
  const Image drawn = renderer_->Render(state, camera_, spec_);
  // Of the fold, 2 cm behind the knee, where no outline is.
  const urdf::Pose& knee = state.people[0].links[urdf::kRightLowerLeg];
  const Projected at = Project(knee.position, camera_, spec_.width, spec_.height);
  int dark = 0;
  for (int y = static_cast<int>(at.y_px) - 60; y < static_cast<int>(at.y_px) + 60; ++y) {
    const std::size_t i = 4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(spec_.width) +
                               static_cast<std::size_t>(at.x_px - 0.09 * at.px_per_m));
    const Rgb pixel = {drawn.rgba[i] / 255.0, drawn.rgba[i + 1] / 255.0, drawn.rgba[i + 2] / 255.0};
    dark += ColorDifference(pixel, ink) < 40 ? 1 : 0;
  }
  EXPECT_GE(dark, 1);
}

// Brows, lids, nose, mouth.
TEST_F(Creases, AreAccompaniedByTheLinesOfAFaceThatIsLargeEnough) {
  spec_.lines = false;
  const auto strokes = [&](double away) {
    camera_ = FrontCamera();
    camera_.position.x() = away;
    renderer_->Render(Person(), camera_, spec_);
    const std::string layer = renderer_->OverlayLayer(Person(), camera_, spec_, LayerFormat::kSvg);
    int count = 0;
    for (std::size_t at = 0; (at = layer.find("stroke-width:1.33", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  EXPECT_EQ(strokes(4), 7);
  EXPECT_EQ(strokes(12), 0);
}

TEST(SuitColors, AreFarFromEveryLoadClass) {
  const SuitColors suit;
  for (const Rgb& color : {suit.top, suit.trousers, suit.shoes, suit.bare, suit.band}) {
    for (const LoadClass load :
         {LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh, LoadClass::kUnknown}) {
      EXPECT_GE(ColorDifference(color, ColorOf(load)), 20);
    }
  }
}

}  // namespace
}  // namespace kinescope::render
