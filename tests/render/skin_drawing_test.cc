// A person drawn as one skin, tested by what the picture shows.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/color_difference.h"
#include "core/palette.h"
#include "render/image/compare.h"
#include "render/renderer.h"
#include "tests/render/test_scene.h"
#include "tests/urdf/rig/rig_samples.h"
#include "tests/worn.h"
#include "urdf/rig/rig.h"
#include "urdf/rig/rigged_skin.h"

namespace kinescope::render {
namespace {

using kinescope::testing::BodyAlone;
using kinescope::testing::FrontCamera;
using kinescope::testing::Posture;

constexpr int kWidth = 480, kHeight = 480;

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
    spec_.width = kWidth;
    spec_.height = kHeight;
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
