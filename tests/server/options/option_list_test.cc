#include "server/options/option_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "core/system/errors.h"
#include "server/options/yaml_options.h"
#include "tests/temp_folder.h"

namespace kinescope::options {
namespace {

using kinescope::testing::TempFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Values {
  Number mass{75, {20, 300, "kg"}};
  Choice<int> tf{{{"flat", 0}, {"tree", 1}, {"off", 2}}, 0};
  Flag loop;
  List<std::string> show{"words",
                         3,
                         [](const std::string& word) {
                           if (word.size() > 9) throw BadValue("expected short words");
                           return word;
                         },
                         {{"frames", "link_axes"}}};

  void List(OptionList& option) {
    option("mass", mass, "body mass");
    option("tf", tf, "frames");
    option("loop", loop, "start again");
    option("show", show, "parts");
    option.Formerly("parts");
  }
};

class OptionListTest : public ::testing::Test {
 protected:
  OptionListTest() { values_.List(list_); }

  std::string Write(const std::string& text) const {
    const std::string path = folder_ / "options.yaml";
    std::ofstream(path) << text;
    return path;
  }
  template <class Function>
  static std::string ErrorOf(Function&& function) {
    try {
      function();
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  }

  TempFolder folder_;
  Values values_;
  OptionList list_;
};

TEST_F(OptionListTest, PrefersTheCommandLineToParametersAndParametersToYaml) {
  list_.Set(*list_.Find("mass"), "mass", {"90"}, Channel::kCommandLine);
  YamlOptions(Write("mass: 80\ntf: tree\nloop: true\n")).SetAll(list_);
  SetFrom(
      [](const std::string& name) -> std::optional<Found> {
        if (name == "loop") return std::nullopt;
        return Found{name == "mass" ? "70" : "off", "~"};
      },
      Channel::kParameter, list_);
  EXPECT_EQ(*values_.mass, 90);
  EXPECT_EQ(*values_.tf, 2);
  EXPECT_TRUE(*values_.loop);
}

TEST_F(OptionListTest, ReportsPlaceValueAndNearestWordOfAnError) {
  EXPECT_EQ(ErrorOf([&] { list_.Set(*list_.Find("tf"), "tf", {"tre"}, Channel::kCommandLine); }),
            "--tf=tre: expected flat, tree or off; nearest: tree");
  const std::string path = Write("tf: tree\nmass: heavy\n");
  EXPECT_EQ(ErrorOf([&] { YamlOptions(path).SetAll(list_); }),
            path + ":2: mass=heavy: expected a number from 20 to 300 kg");
}

TEST_F(OptionListTest, ReadsAListWhereAnOptionMayBeGivenSeveralTimes) {
  Texts robots;
  list_("robot", robots, "a robot beside the people");
  YamlOptions(Write("robot: [a.urdf, 'b.urdf,base_z=1']\n")).SetAll(list_);
  EXPECT_THAT(robots.ToTexts(), ::testing::ElementsAre("a.urdf", "b.urdf,base_z=1"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("robot: [[a.urdf]]\n")).SetAll(list_); }),
              HasSubstr("options.yaml:1: robot: expected a list of values"));
}

TEST_F(OptionListTest, ReportsFileAndLineOfAnUnreadableFile) {
  EXPECT_THAT(ErrorOf([] { YamlOptions("/nowhere.yaml"); }), HasSubstr("/nowhere.yaml: "));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("- 1\n- 2\n")); }), HasSubstr("expected lines of"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: tree\nloop: [\n")); }),
              AllOf(HasSubstr("options.yaml:"), HasSubstr("not valid YAML")));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: tree\nmas: 80\n")).SetAll(list_); }),
              AllOf(HasSubstr("options.yaml:2: unknown option 'mas'"), HasSubstr("nearest: mass")));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: [tree]\n")).SetAll(list_); }),
              HasSubstr("options.yaml:1: tf: expected one value"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: tree\nmass: 80\ntf: flat\n")).SetAll(list_); }),
              HasSubstr("options.yaml:3: tf: given twice, first in line 1"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: tree\n[mass]: 80\n")).SetAll(list_); }),
              HasSubstr("options.yaml:2: expected the name of an option before ':'"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: tree\n---\nmass: 80\n")); }),
              HasSubstr("not valid YAML (a second document; remove the line '---' before it)"));
}

// A short file must not stand for a very long one.
TEST_F(OptionListTest, RejectsYamlThatIsTooLongTooDeepOrRepeatsItself) {
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: " + std::string(1 << 20, 'x'))); }),
              HasSubstr("options.yaml:1: not valid YAML (too long; at most 1048576 bytes)"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions("/dev/zero"); }), HasSubstr("too long"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: tree\nmass: " + std::string(100'000, '['))); }),
              HasSubstr("options.yaml:2: not valid YAML (too many levels; at most 16)"));
  EXPECT_THAT(ErrorOf([&] { YamlOptions(Write("tf: &a [x, x]\nmass: [*a, *a]\n")); }),
              HasSubstr("options.yaml:2: not valid YAML (alias; write the value itself)"));
}

TEST_F(OptionListTest, AcceptsAFormerNameWithAWarning) {
  YamlOptions(Write("parts: body\n")).SetAll(list_);
  EXPECT_THAT(*values_.show, ElementsAre("body"));
  ASSERT_EQ(list_.warnings().size(), 1U);
  EXPECT_THAT(list_.warnings().front(),
              HasSubstr("options.yaml:1: parts: this option is now called show"));
  EXPECT_THAT(ErrorOf([&] {
                list_.Set(*list_.Find("parts"), "parts", {"a_long_word"}, Channel::kCommandLine);
              }),
              HasSubstr("--parts=a_long_word: expected short words"));
}

TEST_F(OptionListTest, RejectsAnOptionWithoutEffectUnlessARosParameterSetIt) {
  list_.HasNoEffect("mass", "with --tf=off", [this] { return *values_.tf == 2; });
  list_.Set(*list_.Find("tf"), "tf", {"off"}, Channel::kCommandLine);
  list_.CheckEffects();  // by default, the mass was not given
  list_.Set(*list_.Find("mass"), "mass", {"80"}, Channel::kParameter);
  list_.CheckEffects();
  list_.Set(*list_.Find("mass"), "mass", {"80"}, Channel::kCommandLine);
  EXPECT_EQ(ErrorOf([&] { list_.CheckEffects(); }), "--mass=80: has no effect with --tf=off");
  list_.Set(*list_.Find("tf"), "tf", {"flat"}, Channel::kCommandLine);
  list_.CheckEffects();
}

TEST_F(OptionListTest, NamesTheLineThatSetAnOptionWithoutEffect) {
  list_.HasNoEffect("mass", "with --tf=off", [this] { return *values_.tf == 2; });
  const std::string path = Write("tf: off\nmass: 80\n");
  YamlOptions(path).SetAll(list_);
  EXPECT_EQ(ErrorOf([&] { list_.CheckEffects(); }),
            path + ":2: mass=80: has no effect with --tf=off");
  EXPECT_EQ(list_.Find("mass")->given_as, path + ":2: mass");
  EXPECT_EQ(list_.Find("loop")->given_as, "");
}

TEST_F(OptionListTest, LeavesOutRemovedOptionsAndTheirConditions) {
  list_.HasNoEffect("mass", "ever", [] { return true; });
  list_.Remove({"mass", "loop"});
  EXPECT_THAT(list_.Names(), ElementsAre("tf", "show"));
  list_.CheckEffects();
}

TEST_F(OptionListTest, ReplacesAFormerValueWithAWarning) {
  list_.Set(*list_.Find("show"), "show", {"body;frames"}, Channel::kCommandLine);
  EXPECT_THAT(*values_.show, ElementsAre("body", "link_axes"));
  EXPECT_EQ(values_.show.ToText(), "body,link_axes") << "the next version reads it, too";
  ASSERT_EQ(list_.warnings().size(), 1U);
  EXPECT_THAT(list_.warnings().front(),
              HasSubstr("--show=frames: this value is now called link_axes"));
}

}  // namespace
}  // namespace kinescope::options
