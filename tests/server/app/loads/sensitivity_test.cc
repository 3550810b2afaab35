#include "server/app/loads/sensitivity.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/scene/scene_reader.h"
#include "tests/server/app/loads/trial_scenes.h"

namespace kinescope::app {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::string> LabelsOf(const SceneOptions& scene) {
  std::vector<std::string> labels;
  for (const Variation& each : VariationsOf(scene)) labels.push_back(each.label);
  return labels;
}

TEST(Sensitivity, VariesMassHandLoadTableAccelerationsAndStrength) {
  SceneOptions scene;
  scene.body.mass_kg = 75;
  scene.loads.hands.is_known = true;
  scene.loads.hands.both_kg = 20;
  EXPECT_THAT(LabelsOf(scene),
              ElementsAre("mass 67.5 kg (−10 %)", "mass 82.5 kg (+10 %)", "hand load 18 kg (−2 kg)",
                          "hand load 22 kg (+2 kg)", "segment masses: Winter",
                          "without accelerations", "strength: weakest 5 %"));
  const std::vector<Variation> variations = VariationsOf(scene);
  EXPECT_DOUBLE_EQ(variations[0].scene.body.mass_kg, 67.5);
  EXPECT_DOUBLE_EQ(variations[3].scene.loads.hands.both_kg, 22);
  EXPECT_FALSE(variations[5].scene.loads.motion.dynamic);
  EXPECT_EQ(variations[6].scene.loads.strength.percentile, loads::Percentile::k5);
  EXPECT_DOUBLE_EQ(variations[6].scene.body.mass_kg, 75) << "one change at a time";
}

TEST(Sensitivity, VariesSmallHandLoadsByOneKilogramButNotBelowZero) {
  SceneOptions scene;
  scene.loads.hands.is_known = true;
  scene.loads.hands.mass_kg = {0.6, 0};
  EXPECT_THAT(LabelsOf(scene), Contains("hand load 0 kg (−0.6 kg)"));
  EXPECT_THAT(LabelsOf(scene), Contains("hand load 1.6 kg (+1 kg)"));
}

TEST(Sensitivity, SupposesAHandLoadOnlyWhereItIsUnknown) {
  SceneOptions scene;
  EXPECT_THAT(LabelsOf(scene), Contains("hand load 5 kg, both"));
  scene.loads.hands.is_known = true;
  EXPECT_THAT(LabelsOf(scene), Not(Contains(::testing::HasSubstr("hand load"))));
}

// The rows are named once it is known what the recording says.
TEST(Sensitivity, VariesWhatARecordingMaySay) {
  SceneOptions scene;
  const std::vector<Variation> variations = VariationsOf(scene, /*may_be_told=*/true);
  ASSERT_GT(variations.size(), 5U);
  EXPECT_DOUBLE_EQ(variations[0].scene.supposed.mass_factor, 0.9);
  EXPECT_EQ(variations[2].of, Variation::Of::kUnknownHandLoad);
  EXPECT_DOUBLE_EQ(variations[2].scene.supposed.hand_load.both_kg, 5);
  EXPECT_FALSE(variations[2].scene.loads.hands.is_known);
  EXPECT_DOUBLE_EQ(variations[4].scene.supposed.hand_load_factor, 1.1);
  scene.loads.hands.is_known = true;
  scene.loads.hands.both_kg = 20;
  EXPECT_EQ(VariationsOf(scene, true)[2].label, "hand load 18 kg (−2 kg)") << "an option counts";
}

TEST(Sensitivity, KnowsOfAMassThatWasToldForAPartOfTheTrial) {
  StatedKg kg;
  kg.Add(false, 0);
  EXPECT_FALSE(kg.is_known());
  EXPECT_FALSE(kg.changes());
  kg.Add(true, 10);
  kg.Add(true, 0);
  EXPECT_TRUE(kg.is_known());
  EXPECT_TRUE(kg.changes());
  EXPECT_EQ(kg.most(), 10);
}

TEST(Sensitivity, ChangesWhatTheOptionsHaveAlreadyChanged) {
  SceneOptions scene;
  scene.body.table = urdf::BodyTable::kWinter;
  scene.loads.motion.dynamic = false;
  scene.loads.strength.percentile = loads::Percentile::k5;
  const std::vector<std::string> labels = LabelsOf(scene);
  for (const char* label : {"segment masses: de Leva", "with accelerations", "strength: median"}) {
    EXPECT_THAT(labels, Contains(label));
  }
}

TEST(Sensitivity, LeavesOutAMassThatNoPersonHas) {
  SceneOptions scene;
  scene.body.mass_kg = 21;
  EXPECT_THAT(LabelsOf(scene), Not(Contains(::testing::HasSubstr("−10 %"))));
}

// Each row against the same options in a trial of its own.
TEST(Sensitivity, CountsTheSamplesThatATrialWithTheseOptionsCounts) {
  constexpr double kSecs = 1.0;
  SceneOptions scene;
  scene.loads.hands.is_known = true;
  scene.loads.hands.both_kg = 15;
  SceneReader reader("demo:lift", scene);
  Sensitivity sensitivity(scene, kSecs, reader);
  for (int i = 0; i <= 120; ++i) sensitivity.AddAsComputed(reader.Next()->people[0]);
  const std::vector<SensitivityRow> rows = sensitivity.RowsOf(0);
  const std::vector<Variation> variations = VariationsOf(scene);
  ASSERT_EQ(rows.size(), variations.size() + 1);
  const auto check = [&](const SensitivityRow& row, const SceneOptions& options) {
    const LoadTrial trial = testing::TrialOf(testing::ReadScenes("demo:lift", kSecs, options));
    EXPECT_EQ(row.samples, trial.samples()) << row.label;
    EXPECT_EQ(row.peak_compression, trial.compression().most) << row.label;
    for (std::size_t i = 0; i < urdf::kScoredJointCount; ++i) {
      const auto& samples = trial.exposure().Of(i).samples;
      const std::uint64_t high = samples[static_cast<std::size_t>(LoadClass::kHigh)];
      EXPECT_EQ(row.above[1][i], high) << row.label;
      EXPECT_EQ(row.above[0][i], high + samples[static_cast<std::size_t>(LoadClass::kMedium)])
          << row.label;
    }
    EXPECT_FLOAT_EQ(row.low_back_p90, static_cast<float>(trial.exposure().Of(0).p90)) << row.label;
  };
  check(rows[0], scene);
  for (std::size_t i = 0; i < variations.size(); ++i) check(rows[i + 1], variations[i].scene);
  EXPECT_THAT(sensitivity.RowsOf(7), IsEmpty()) << "nobody";
}

}  // namespace
}  // namespace kinescope::app
