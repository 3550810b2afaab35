#include "server/scene/wrench_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/system/errors.h"

namespace kinescope::app {
namespace {

using ::testing::HasSubstr;
using wrenches::WrenchBody;

// Sets an option as the command line does. "": accepted.
std::string SetWrenchOption(WrenchOptions& values, const std::string& name,
                            const std::string& text) {
  options::OptionList list;
  values.List(list);
  try {
    list.Set(*list.Find(name), name, {text}, options::Channel::kCommandLine);
    list.CheckEffects();
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(WrenchOptions, BecomeSettings) {
  WrenchOptions values;
  EXPECT_FALSE(ToWrenchSettings(values));
  EXPECT_EQ(SetWrenchOption(values, "wrenches", "a.mot"), "");
  EXPECT_EQ(SetWrenchOption(values, "wrench_bodies",
                            "ground_force=RightFoot,1_ground_force=left_foot, handle=none"),
            "");
  EXPECT_EQ(SetWrenchOption(values, "wrench_offset", "-0.25"), "");
  EXPECT_EQ(SetWrenchOption(values, "wrench_place", "1,-2,90"), "");
  EXPECT_EQ(SetWrenchOption(values, "wrench_sign", "on_plate"), "");
  const auto settings = ToWrenchSettings(values);
  ASSERT_TRUE(settings);
  EXPECT_EQ(settings->path, "a.mot");
  ASSERT_EQ(settings->groups.size(), 3U);
  EXPECT_EQ(settings->groups[1].group, "1_ground_force");
  EXPECT_EQ(settings->groups[1].body, WrenchBody::kLeftFoot);
  EXPECT_FALSE(settings->groups[2].body);
  EXPECT_EQ(settings->offset_secs, -0.25);
  EXPECT_TRUE(settings->is_on_plate);
  EXPECT_TRUE(settings->place.isApprox(Eigen::Vector3d(1, -2, M_PI / 2)));
}

TEST(WrenchOptions, NameTheirFileForProvenance) {
  WrenchOptions values;
  EXPECT_TRUE(values.wrenches.Files().empty());
  values.wrenches = "forces.csv";
  EXPECT_EQ(values.wrenches.Files(), std::vector<std::filesystem::path>{"forces.csv"});
}

TEST(WrenchOptions, RefuseWhatTheyDoNotKnow) {
  WrenchOptions values;
  EXPECT_THAT(SetWrenchOption(values, "wrenches", "forces.c3d"),
              HasSubstr("expected FILE.csv, FILE.mot or FILE.sto"));
  values.wrenches = "forces.csv";
  EXPECT_THAT(SetWrenchOption(values, "wrench_bodies", "ground_force"),
              HasSubstr("expected GROUP=BODY"));
  EXPECT_THAT(SetWrenchOption(values, "wrench_bodies", "ground_force=Nose"),
              HasSubstr("unknown body 'Nose'"));
  EXPECT_THAT(SetWrenchOption(values, "wrench_place", "1,2"), HasSubstr("X,Y,YAW"));
  EXPECT_THAT(SetWrenchOption(values, "wrench_place", "1,2,361"), HasSubstr("X,Y,YAW"));
  EXPECT_THAT(SetWrenchOption(values, "wrench_sign", "down"), HasSubstr("on_person or on_plate"));
}

TEST(WrenchOptions, HaveNoEffectWithoutTheFile) {
  for (const auto& [name, text] :
       std::vector<std::pair<std::string, std::string>>{{"wrench_bodies", "a=none"},
                                                        {"wrench_offset", "1"},
                                                        {"wrench_place", "0,0,0"},
                                                        {"wrench_sign", "on_plate"}}) {
    WrenchOptions values;
    EXPECT_THAT(SetWrenchOption(values, name, text), HasSubstr("has no effect without --wrenches"));
  }
}

}  // namespace
}  // namespace kinescope::app
