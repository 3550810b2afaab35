#include "render/overlay_legend.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/render/test_scene.h"

namespace kinescope::render {
namespace {

using kinescope::testing::Posture;
using kinescope::testing::SceneWith;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;
using ::testing::Not;
using ::testing::StartsWith;

// Keeps the texts and the boxes, and paints nothing.
class TextRecorder : public Painter {
 public:
  void Enter(const Tile& /*part*/) override {}
  void RoundedBox(double x, double /*y*/, double width, double /*height*/, double /*radius*/,
                  const Ink& /*ink*/) override {
    right = x + width;
  }
  void Disc(double /*x*/, double /*y*/, double /*radius*/, const Ink& /*ink*/) override {}
  void Ring(double /*x*/, double /*y*/, double /*inner_radius*/, double /*outer_radius*/,
            const Ink& /*ink*/) override {}
  void Polyline(const std::vector<std::pair<double, double>>& /*points*/, double /*width*/,
                const Ink& /*ink*/) override {
    ++lines;
  }
  double Text(double x, double /*y*/, std::string_view utf8, Font& font, int size_px,
              const Ink& /*ink*/) override {
    texts.emplace_back(utf8);
    return x + font.Width(utf8, size_px);
  }

  std::vector<std::string> texts;
  double right = 0;  // of the last box, px
  int lines = 0;
};

TextRecorder PaintedLegend(const SceneState& state, double width_px) {
  TextRecorder painter;
  OverlayFonts fonts;
  OverlayPage page({fonts, width_px, 720, 1, 720, false}, painter, kLightInks);
  PaintLegend(page, LegendOf(state, SceneLook()), state.class_limits);
  return painter;
}

std::vector<std::string> NamesOf(const std::vector<LegendRow>& rows) {
  std::vector<std::string> names;
  for (const LegendRow& row : rows) names.push_back(row.name);
  return names;
}

TEST(OverlayLegend, NamesTheLimitsOfTheClasses) {
  SceneState state = SceneWith(Posture::kStanding);
  state.class_limits = {0.1, 0.255};
  const std::vector<LegendRow> rows = LegendOf(state, SceneLook()).rows;
  ASSERT_GE(rows.size(), 4u);
  EXPECT_EQ(rows[0].range, "≤ 10 %");
  EXPECT_EQ(rows[1].range, "≤ 25.5 %");
  EXPECT_EQ(rows[2].range, "> 25.5 %");
  EXPECT_EQ(rows[2].rim, SphereRim::kDark) << "the high class differs in shape, too";
}

TEST(OverlayLegend, HasNoRowForAHiddenElement) {
  const SceneState state = SceneWith(Posture::kStanding);
  SceneLook look;
  for (const ScenePart part : {ScenePart::kCom, ScenePart::kCop}) look.shown.Set(part, true);
  look.shown.Set(ScenePart::kLoads, false);
  EXPECT_THAT(NamesOf(LegendOf(state, look).rows),
              ElementsAre("centre of mass", "centre of pressure"));
  for (const ScenePart part : {ScenePart::kCom, ScenePart::kCop}) look.shown.Set(part, false);
  EXPECT_TRUE(LegendOf(state, look).is_empty());
}

TEST(OverlayLegend, ExplainsForceArrowsIfAForceActsOnAFoot) {
  SceneState state = SceneWith(Posture::kStanding);
  SceneLook look;
  look.shown.Set(ScenePart::kForces, true);
  FootForce& foot = state.people[0].forces.feet[0];
  foot = {};
  foot.force = {0, 0, 400};
  state.people[0].forces.feet[1] = {};
  EXPECT_THAT(NamesOf(LegendOf(state, look).rows), Not(Contains("ground reaction force")));
  foot.touches_floor = true;
  const std::vector<LegendRow> rows = LegendOf(state, look).rows;
  EXPECT_EQ(rows.back().name, "ground reaction force");
  EXPECT_EQ(rows.back().symbol, LegendRow::Symbol::kArrow);
}

TEST(OverlayLegend, CoversAtMostThreeTenthsOfThePictureOrShowsTheClassesOnly) {
  const SceneState state = SceneWith(Posture::kStanding);
  const TextRecorder wide = PaintedLegend(state, 1280), narrow = PaintedLegend(state, 500);
  EXPECT_EQ(wide.texts.front(), "Joint load, % of capacity");
  EXPECT_LE(wide.right, kMargin + 0.3 * 1280);
  EXPECT_THAT(narrow.texts, ElementsAre("≤ 30", "≤ 60", "> 60 %"));
}

// Without it, nothing tells what the length of an arrow means.
TEST(OverlayLegend, TellsTheScaleOfForceArrowsInPicturesOfAnyWidth) {
  SceneState state = SceneWith(Posture::kStanding);
  FootForce& foot = state.people[0].forces.feet[0];
  foot.force = {0, 0, 400};
  foot.touches_floor = true;
  const auto texts_at = [&](double width_px) { return PaintedLegend(state, width_px).texts; };
  EXPECT_THAT(texts_at(1280), IsSupersetOf({"ground reaction force", "1 m/kN"}));
  EXPECT_THAT(texts_at(750), IsSupersetOf({"GRF", "1 m/kN"}));
  EXPECT_THAT(texts_at(600), ElementsAre("≤ 30", "≤ 60", "> 60 %", "1 m/kN"));
  EXPECT_THAT(texts_at(360), ElementsAre("≤ 30", "≤ 60", "> 60 %"));
}

TEST(OverlayLegend, EndsWithTheAssumedBodyMass) {
  SceneState state = SceneWith(Posture::kStanding);
  auto model = std::make_shared<PersonModel>(*state.people[0].model);
  model->description.mass_is_assumed = true;
  model->description.mass_kg = 75;
  state.people[0].model = model;
  EXPECT_EQ(PaintedLegend(state, 1280).texts.back(), "body mass assumed: 75 kg");
  state.people[0].loads.clear();
  EXPECT_THAT(PaintedLegend(state, 1280).texts, Each(Not(StartsWith("body mass"))))
      << "without loads nothing depends on it";
}

}  // namespace
}  // namespace kinescope::render
