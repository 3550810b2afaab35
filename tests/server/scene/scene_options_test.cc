#include "server/scene/scene_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/system/errors.h"
#include "tests/server/options_testing.h"

namespace kinescope::app {
namespace {

using ::testing::AllOf;
using testing::ErrorOfSetting;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using testing::With;

TEST(PersonOptions, AssumeAMassOnlyWhenNoneIsGiven) {
  EXPECT_TRUE(ToBody(PersonOptions()).mass_is_assumed);
  EXPECT_EQ(ToBody(PersonOptions()).mass_kg, 75);
  EXPECT_EQ(ToBody(With<PersonOptions>({{"sex", "female"}})).mass_kg, 62);
  const auto given = ToBody(With<PersonOptions>({{"sex", "female"}, {"mass", "54"}}));
  EXPECT_EQ(given.mass_kg, 54);
  EXPECT_FALSE(given.mass_is_assumed);
}

TEST(PersonOptions, MarkAssumedValues) {
  EXPECT_TRUE(ToSceneOptions(PersonOptions()).body.sex_is_assumed);
  EXPECT_TRUE(ToSceneOptions(PersonOptions()).height_is_assumed);
  const auto scene = ToSceneOptions(With<PersonOptions>({{"sex", "male"}, {"height", "1.75"}}));
  EXPECT_FALSE(scene.body.sex_is_assumed);
  EXPECT_FALSE(scene.height_is_assumed);
}

TEST(PersonOptions, RejectBodiesOutsideTheLimits) {
  for (const char* mass : {"0", "-1", "5", "500", "nan", "inf", "heavy", ""}) {
    EXPECT_THAT(ErrorOfSetting<PersonOptions>("mass", mass),
                AllOf(StartsWith("--mass=" + std::string(mass) + ": "), HasSubstr("20 to 300 kg")));
  }
  EXPECT_THAT(ErrorOfSetting<PersonOptions>("height", "17.5"), HasSubstr("0.5 to 2.5 m"));
  EXPECT_THAT(ErrorOfSetting<PersonOptions>("sex", "femal"),
              HasSubstr("expected male or female; nearest: female"));
  EXPECT_THAT(ErrorOfSetting<PersonOptions>("body_table", "tailor"), HasSubstr("de_leva"));
}

TEST(PersonOptions, AcceptExtraMassesSeparatedByCommasOrSemicolons) {
  const urdf::BodyDescription body = ToBody(With<PersonOptions>(
      {{"body_table", "dumas"}, {"extra_mass", "Head:1.5@0,0,0.12, t8:8;pelvis:0.7"}}));
  EXPECT_EQ(body.table, urdf::BodyTable::kDumas);
  ASSERT_EQ(body.added_masses.size(), 3U);
  EXPECT_EQ(body.added_masses[0].segment, urdf::kHead);
  EXPECT_EQ(body.added_masses[0].position_in_link, Eigen::Vector3d(0, 0, 0.12));
  EXPECT_EQ(body.added_masses[1].segment, urdf::kT8);
  EXPECT_EQ(body.added_masses[1].mass_kg, 8);
  EXPECT_EQ(body.added_masses[2].segment, urdf::kPelvis);
}

TEST(PersonOptions, NameAnInvalidExtraMass) {
  for (const char* bad : {"head", "tail:1", "head:0", "head:-1", "head:nan", "head:500",
                          "head:1@0,0,9", "head:1@0,0", ";", "head:1 t8:2"}) {
    EXPECT_THAT(ErrorOfSetting<PersonOptions>("extra_mass", bad),
                AllOf(StartsWith("--extra_mass=" + std::string(bad) + ": "), HasSubstr("expected"),
                      Not(HasSubstr("\n"))));
  }
}

TEST(PersonOptions, AcceptOnlyModelNamesThatAreValidInLinkNames) {
  for (const char* good : {"skeleton", "anna_2", "Person1", "_"}) {
    const auto person = With<PersonOptions>({{"model_name", good}, {"body_model", "primitive"}});
    EXPECT_EQ(ToSceneOptions(person).model_name, good);
  }
  for (const char* bad : {"", "a b/", "/anna", "anna-2", "J\xC3\xBCrgen", "a.b"}) {
    EXPECT_EQ(ErrorOfSetting<PersonOptions>("model_name", bad),
              std::string("--model_name=") + bad + ": expected letters, digits and _");
  }
}

TEST(LoadOptions, AreConvertedToLoadSettings) {
  EXPECT_FALSE(ToLoadSettings(LoadOptions()).hands.is_known);
  const loads::LoadSettings settings =
      ToLoadSettings(With<LoadOptions>({{"capacity_factor", "0.8"},
                                        {"capacity_percentile", "5"},
                                        {"load_metric", "overload"},
                                        {"load_mode", "static"},
                                        {"hand_load", "right:5,left:2.5@0,0,-0.2"},
                                        {"filter_hz", "8"},
                                        {"lumbar_compression", "off"}}));
  EXPECT_EQ(settings.strength.factor, 0.8);
  EXPECT_EQ(settings.strength.percentile, loads::Percentile::k5);
  EXPECT_EQ(settings.metric, LoadMetric::kOverload);
  EXPECT_FALSE(settings.motion.dynamic);
  EXPECT_EQ(settings.motion.cutoff_hz, 8);
  EXPECT_FALSE(settings.compression_counts);
  ASSERT_TRUE(settings.hands.is_known);
  EXPECT_EQ(settings.hands.mass_kg[urdf::kRight], 5);
  EXPECT_EQ(settings.hands.mass_kg[urdf::kLeft], 2.5);
  EXPECT_EQ(settings.hands.com_in_hand[urdf::kLeft], Eigen::Vector3d(0, 0, -0.2));
  EXPECT_TRUE(ToLoadSettings(With<LoadOptions>({{"hand_load", "none"}})).hands.is_known);
}

TEST(LoadOptions, GiveClassLimitsHysteresis) {
  const auto defaults = ToLoadSettings(LoadOptions()).meter;
  EXPECT_EQ(defaults.up, loads::LoadMeter::Settings().up);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_DOUBLE_EQ(defaults.down[i], loads::LoadMeter::Settings().down[i]);
  }
  const auto classes = ToLoadSettings(With<LoadOptions>({{"class_limits", "0.06, 0.9"}})).meter;
  EXPECT_DOUBLE_EQ(classes.down[0], 0.05);
  EXPECT_DOUBLE_EQ(classes.down[1], 0.85);
  for (const char* bad :
       {"", "0.3", "0.6,0.3", "0,0.6", "0.3,nan", "0.3,60", "30 %,60 %", "1,2,3"}) {
    EXPECT_THAT(ErrorOfSetting<LoadOptions>("class_limits", bad), HasSubstr("0.3,0.6"));
  }
}

TEST(LoadOptions, AreRejectedWithTheirValueAndTheWholeRange) {
  const auto expect = [](const char* name, const char* value) {
    EXPECT_THAT(ErrorOfSetting<LoadOptions>(name, value),
                AllOf(StartsWith("--" + std::string(name) + "=" + value + ": "),
                      HasSubstr("expected"), Not(HasSubstr("\n"))));
  };
  expect("capacity_percentile", "42");
  expect("load_metric", "most");
  expect("load_mode", "quick");
  expect("lumbar_compression", "maybe");
  for (const char* bad :
       {"right", "tail:5", "right:500", "right:-5", "right:nan", "both:1@0,0,0", "right:5@0,0,9"}) {
    expect("hand_load", bad);
  }
  for (const char* bad : {"0", "-1", "50", "nan", "1e400", "0x1"}) {
    expect("capacity_factor", bad);
    expect("filter_hz", bad);
  }
}

}  // namespace
}  // namespace kinescope::app
