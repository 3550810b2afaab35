#include "server/app/pipeline_options.h"

#include <gtest/gtest.h>

#include "server/core/errors.h"

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
  for (const double mass : {-1.0, 5.0, 500.0, std::nan("")}) {
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
