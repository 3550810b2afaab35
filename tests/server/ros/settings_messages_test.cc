#include "server/ros/settings_messages.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinescope::ros_bridge {
namespace {

using dynamic_reconfigure::Config;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const std::vector<std::string> kSomeCameras = {"front", "side"};

LiveSettings SomeSettings() {
  LiveSettings now;
  now.mass_kg = 75;
  now.height_m = 1.75;
  now.camera = "front";
  return now;
}

Config WithNumber(const std::string& name, double value) {
  Config config;
  config.doubles.emplace_back();
  config.doubles.back().name = name;
  config.doubles.back().value = value;
  return config;
}

Config WithText(const std::string& name, const std::string& value) {
  Config config;
  config.strs.emplace_back();
  config.strs.back().name = name;
  config.strs.back().value = value;
  return config;
}

WantedSettings Read(const Config& config) {
  return ReadConfig(config, SomeSettings(), kSomeCameras);
}

TEST(SettingsMessages, AreReadAsTheyAreWritten) {
  LiveSettings wanted;
  wanted.class_limits = {0.4, 0.9};
  wanted.mass_kg = 81.5;
  wanted.height_m = 1.9;
  wanted.sex = urdf::Sex::kFemale;
  wanted.camera = "side";
  const WantedSettings read = Read(ToConfig(wanted));
  EXPECT_THAT(read.refused, IsEmpty());
  EXPECT_EQ(read.all, wanted);
  EXPECT_EQ(read.change.class_limits, wanted.class_limits);
  EXPECT_EQ(read.change.person.mass_kg, 81.5);
  EXPECT_EQ(read.change.person.height_m, 1.9);
  EXPECT_EQ(read.change.person.sex, urdf::Sex::kFemale);
  EXPECT_EQ(read.change.camera, "side");
}

TEST(SettingsMessages, ChangeOnlyWhatIsOther) {
  const WantedSettings read = Read(ToConfig(SomeSettings()));
  EXPECT_FALSE(read.change.class_limits || read.change.camera || read.change.person.mass_kg ||
               read.change.person.height_m || read.change.person.sex);
  EXPECT_THAT(Read({}).refused, IsEmpty());
}

TEST(SettingsMessages, KeepNumbersInTheRangeThatIsDescribed) {
  const auto described = DescribeSettings(SomeSettings(), kSomeCameras);
  ASSERT_THAT(described.groups, SizeIs(1));
  ASSERT_THAT(described.groups[0].parameters, SizeIs(6));
  for (std::size_t i = 0; i < described.min.doubles.size(); ++i) {
    const auto &least = described.min.doubles[i], &most = described.max.doubles[i];
    const Config low = ToConfig(Read(WithNumber(least.name, -1e9)).all);
    const Config high =
        ToConfig(Read(WithNumber(least.name, std::numeric_limits<double>::infinity())).all);
    if (least.name == "class_medium" || least.name == "class_high") continue;  // see below
    EXPECT_EQ(low.doubles[i].value, least.value) << least.name;
    EXPECT_EQ(high.doubles[i].value, most.value) << least.name;
  }
  EXPECT_EQ(Read(WithNumber("class_high", 9)).change.class_limits,
            (std::array<double, 2>{kDefaultClassLimits[0], 5}));
}

TEST(SettingsMessages, RefuseWhatTheyCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Read(WithNumber("mass", nan)).refused, ElementsAre("mass: not a number"));
  EXPECT_THAT(Read(WithNumber("weight", 80)).refused,
              ElementsAre("weight: no parameter that is a number"));
  EXPECT_THAT(Read(WithText("sex", "?")).refused, ElementsAre("sex: '?' is none of male, female"));
  EXPECT_THAT(Read(WithText("camera", "behind")).refused,
              ElementsAre("camera: 'behind' is none of front, side"));
  EXPECT_THAT(ReadConfig(WithText("camera", "front"), {}, {}).refused,
              ElementsAre("camera: no parameter that is a text"));
  const WantedSettings falling = Read(WithNumber("class_medium", 0.7));
  EXPECT_THAT(falling.refused, ElementsAre("class_medium, class_high: 0.7 is not below 0.6"));
  EXPECT_EQ(falling.all, SomeSettings());
}

TEST(SettingsMessages, NameOnlySoManyProblems) {
  Config flood;
  for (int i = 0; i < 10'000; ++i) {
    flood.doubles.push_back(WithNumber(std::string(1000, 'x'), 1).doubles[0]);
  }
  const WantedSettings read = Read(flood);
  EXPECT_THAT(read.refused, SizeIs(20));
  EXPECT_LT(read.refused[0].size(), 200u);
}

TEST(SettingsMessages, DescribeChoicesAsClientsReadThem) {
  const auto described = DescribeSettings(SomeSettings(), kSomeCameras);
  EXPECT_THAT(described.groups[0].parameters.back().edit_method,
              HasSubstr("{'enum': [{'name': 'front', 'type': 'str', 'value': 'front'"));
  EXPECT_THAT(DescribeSettings(SomeSettings(), {}).groups[0].parameters, SizeIs(5));
}

}  // namespace
}  // namespace kinescope::ros_bridge
