#include "server/scene/scene_options.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/errors.h"
#include "server/app/serve/serve_options.h"
#include "server/options/choose.h"

namespace kinescope::app {
namespace {

TEST(PipelineOptions, AssumeAMassOnlyWhenNoneIsGivenAndSaySo) {
  PersonOptions person;
  EXPECT_TRUE(ToSceneOptions(person, 0.5).body.mass_is_assumed);
  EXPECT_EQ(ToSceneOptions(person, 0.5).body.mass_kg, 75);
  person.sex = "female";
  EXPECT_EQ(ToSceneOptions(person, 0.5).body.mass_kg, 62);
  person.mass = 54;
  EXPECT_EQ(ToSceneOptions(person, 0.5).body.mass_kg, 54);
  EXPECT_FALSE(ToSceneOptions(person, 0.5).body.mass_is_assumed);
}

TEST(PipelineOptions, RefuseBodiesThatNobodyHas) {
  for (const double mass : {0.0, -1.0, 5.0, 500.0, std::nan("")}) {
    PersonOptions person;
    person.mass = mass;
    EXPECT_THROW(ToSceneOptions(person, 0.5), UsageError) << mass;
  }
  PersonOptions person;
  person.height = 17.5;
  EXPECT_THROW(ToSceneOptions(person, 0.5), UsageError);
  person = {};
  person.sex = "other";
  EXPECT_THROW(ToSceneOptions(person, 0.5), UsageError);
}

TEST(PipelineOptions, SayWhatNobodyGave) {
  PersonOptions person;
  EXPECT_TRUE(ToSceneOptions(person, 0.5).body.sex_is_assumed);
  EXPECT_TRUE(ToSceneOptions(person, 0.5).height_is_assumed);
  person.sex = "male";
  person.height = 1.75;
  EXPECT_FALSE(ToSceneOptions(person, 0.5).body.sex_is_assumed);
  EXPECT_FALSE(ToSceneOptions(person, 0.5).height_is_assumed);
}

std::string ErrorOf(const PersonOptions& person, const LoadOptions& loads) {
  try {
    ToSceneOptions(person, 0.5, loads);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "no error";
}

TEST(PipelineOptions, ReadWhatIsWornWithCommasOrSemicolonsBetween) {
  PersonOptions person;
  person.body_table = "dumas";
  person.extra_mass = "Head:1.5@0,0,0.12, t8:8;pelvis:0.7";
  const urdf::BodyDescription body = ToBody(person);
  EXPECT_EQ(body.table, urdf::BodyTable::kDumas);
  ASSERT_EQ(body.extra_masses.size(), 3U);
  EXPECT_EQ(body.extra_masses[0].segment, urdf::kHead);
  EXPECT_EQ(body.extra_masses[0].position_in_link, Eigen::Vector3d(0, 0, 0.12));
  EXPECT_EQ(body.extra_masses[1].segment, urdf::kT8);
  EXPECT_EQ(body.extra_masses[1].mass_kg, 8);
  EXPECT_EQ(body.extra_masses[2].segment, urdf::kPelvis);
}

TEST(PipelineOptions, ReadWhatLoadsAreComputedFrom) {
  LoadOptions options;
  EXPECT_FALSE(ToLoadSettings(options).hands.is_known);
  options.capacity_factor = 0.8;
  options.capacity_percentile = "5";
  options.load_metric = "overload";
  options.load_mode = "static";
  options.hand = "right:5,left:2.5@0,0,-0.2";
  options.filter_hz = 8;
  options.lumbar_compression = "off";
  const loads::LoadSettings settings = ToLoadSettings(options);
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
  options.hand = "none";
  EXPECT_TRUE(ToLoadSettings(options).hands.is_known);
}

TEST(PipelineOptions, AModelNameIsOneThatFitsIntoNamesOfLinks) {
  PersonOptions person;
  person.figure = "primitive";
  for (const char* good : {"skeleton", "anna_2", "Person1", "_"}) {
    person.model_name = good;
    EXPECT_EQ(ToSceneOptions(person, 0.5).model_name, good);
  }
  for (const char* bad : {"", "a b/", "/anna", "anna-2", "J\xC3\xBCrgen", "a.b"}) {
    person.model_name = bad;
    try {
      ToSceneOptions(person, 0.5);
      ADD_FAILURE() << "accepted '" << bad << "'";
    } catch (const UsageError& error) {
      EXPECT_EQ(error.what(),
                std::string("--model_name=") + bad + ": expected letters, digits and _");
    }
  }
}

// Each refusal names the option, the value and what would be right.
TEST(PipelineOptions, ReadClassLimitsWithRoomToFallBack) {
  LoadOptions loads;
  const auto defaults = ToLoadSettings(loads).classes;
  EXPECT_EQ(defaults.up, loads::LoadClassifier::Settings().up);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_DOUBLE_EQ(defaults.down[i], loads::LoadClassifier::Settings().down[i]);
  }
  loads.class_limits = "0.06, 0.9";
  const auto classes = ToLoadSettings(loads).classes;
  EXPECT_DOUBLE_EQ(classes.down[0], 0.05);
  EXPECT_DOUBLE_EQ(classes.down[1], 0.85);
  for (const char* bad :
       {"", "0.3", "0.6,0.3", "0,0.6", "0.3,nan", "0.3,60", "30 %,60 %", "1,2,3"}) {
    loads.class_limits = bad;
    EXPECT_THROW(ToLoadSettings(loads), UsageError) << bad;
  }
}

TEST(PipelineOptions, RefuseLoadsThatMakeNoSense) {
  const auto expect = [](const std::string& error, const std::string& option,
                         const std::string& value) {
    EXPECT_EQ(error.rfind("--" + option, 0), 0U) << error;
    EXPECT_NE(error.find(value), std::string::npos) << error;
    EXPECT_NE(error.find("expected"), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
  };
  const auto person = [&](std::string PersonOptions::*option, const char* name, const char* value) {
    PersonOptions bad;
    bad.*option = value;
    expect(ErrorOf(bad, {}), name, value);
  };
  const auto load = [&](std::string LoadOptions::*option, const char* name, const char* value) {
    LoadOptions bad;
    bad.*option = value;
    expect(ErrorOf({}, bad), name, value);
  };
  person(&PersonOptions::body_table, "body_table", "tailor");
  for (const char* bad : {"head", "tail:1", "head:0", "head:-1", "head:nan", "head:500",
                          "head:1@0,0,9", "head:1@0,0", "head:1,", ";", "head:1 t8:2"}) {
    person(&PersonOptions::extra_mass, "extra_mass", bad);
  }
  load(&LoadOptions::capacity_percentile, "capacity_percentile", "42");
  load(&LoadOptions::load_metric, "load_metric", "most");
  load(&LoadOptions::load_mode, "load_mode", "quick");
  load(&LoadOptions::lumbar_compression, "lumbar_compression", "maybe");
  for (const char* bad :
       {"right", "tail:5", "right:500", "right:-5", "right:nan", "both:1@0,0,0", "right:5@0,0,9"}) {
    load(&LoadOptions::hand, "hand", bad);
  }
  for (const double bad : {0.0, -1.0, 50.0, std::nan("")}) {
    LoadOptions options;
    options.capacity_factor = bad;
    expect(ErrorOf({}, options), "capacity_factor", fmt::format("{}", bad));
    options = {};
    options.filter_hz = bad;
    expect(ErrorOf({}, options), "filter_hz", fmt::format("{}", bad));
  }
}

TEST(PipelineOptions, ReadSizes) {
  EXPECT_EQ(ToSize("size", "1280x720"), std::make_pair(1280, 720));
  for (const char* bad : {"", "1280", "x", "1280x", "x720", "1280x720p", "0x0", "1000000x2", "-5x7",
                          "99999999999999x1"}) {
    EXPECT_THROW(ToSize("size", bad), UsageError) << bad;
  }
}

TEST(PipelineOptions, ReadModesAndSwitches) {
  EXPECT_EQ(ToRosMode("off"), ros_bridge::RosMode::kOff);
  EXPECT_THROW(ToRosMode("maybe"), UsageError);
  EXPECT_EQ(ToStamps("arrival"), mvn::Stamps::kArrival);
  EXPECT_THROW(ToStamps("sender"), UsageError);
  EXPECT_TRUE(ToSwitch("pictures", "on"));
  EXPECT_THROW(ToSwitch("pictures", "yes"), UsageError);
}

}  // namespace
}  // namespace kinescope::app
