#include "server/alarms/rule_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "core/system/errors.h"
#include "tests/folders.h"
#include "tests/temp_folder.h"
#include "urdf/segments.h"

namespace kinescope::alarms {
namespace {

using ::testing::HasSubstr;
using testing::TempFolder;

std::string ErrorOf(const std::string& text) {
  try {
    ParseRules("lab.yaml", text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

Rule OneRule(const std::string& text) {
  const Rules rules = ParseRules("lab.yaml", "rules:\n  - " + text + "\n");
  EXPECT_EQ(rules.rules.size(), 1u);
  return rules.rules.at(0);
}

TEST(RuleFile, TheDefaultRulesAreValid) {
  const Rules rules = LoadRules("default");
  ASSERT_EQ(rules.rules.size(), 4u);
  EXPECT_EQ(rules.rules[0].quantity, Quantity::kCompression);
  EXPECT_TRUE(rules.rules[0].latches);
  EXPECT_FALSE(rules.rules[3].latches);
  EXPECT_EQ(rules.webhook, "");
}

TEST(RuleFile, TheDocumentsShowTheDefaultRules) {
  std::ifstream file(testing::InSourceTree("docs/alarms.md"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_THAT(text, HasSubstr(kDefaultRules));
}

TEST(RuleFile, ReadsEveryKey) {
  const Rules rules = ParseRules("lab.yaml",
                                 "lost_after: 5\nwebhook: https://chat.example/hook?key=1\nrules:\n"
                                 "  - name: back\n    value: ratio\n    joint: l5_s1\n"
                                 "    above: 0.66\n    band: 0.1\n    for: 1.5\n"
                                 "    over_after: 3\n    priority: high\n    latch: false\n");
  EXPECT_EQ(rules.lost_secs, 5);
  EXPECT_EQ(rules.webhook, "https://chat.example/hook?key=1");
  const Rule& rule = rules.rules.at(0);
  EXPECT_EQ(rule.name, "back");
  EXPECT_EQ(rule.joint, urdf::kScoredJoints[urdf::kScoredL5S1]);
  EXPECT_EQ(rule.limit, 0.66);
  EXPECT_EQ(rule.band, 0.1);
  EXPECT_EQ(rule.for_secs, 1.5);
  EXPECT_EQ(rule.over_secs, 3);
  EXPECT_EQ(rule.priority, Priority::kHigh);
  EXPECT_FALSE(rule.latches);
}

TEST(RuleFile, ALoadRatioMayHaveTheLimitOfAClass) {
  const Rule rule = OneRule("{name: a, value: ratio, above: medium}");
  EXPECT_EQ(rule.limit_class, LoadClass::kMedium);
  EXPECT_EQ(rule.limit, kDefaultClassLimits[0]);
  EXPECT_EQ(rule.band, 0.05 * kDefaultClassLimits[0]);
  const Rule wide = OneRule("{name: a, value: ratio, above: high, band: 0.2}");
  EXPECT_EQ(wide.band, 0.2);
  EXPECT_THAT(ErrorOf("rules:\n  - {name: a, value: margin, below: high}"),
              HasSubstr("below: high: expected a number"));
}

TEST(RuleFile, ClassesBeginAtTheClassThatIsNamed) {
  const Rule medium = OneRule("{name: a, value: class, at_least: medium}");
  EXPECT_LT(static_cast<double>(LoadClass::kLow), medium.limit);
  EXPECT_GT(static_cast<double>(LoadClass::kMedium), medium.limit);
  EXPECT_EQ(OneRule("{name: a, value: exposure, of: medium, above: 0.3}").limit, 0.3);
}

TEST(RuleFile, NoRulesAreRules) { EXPECT_TRUE(ParseRules("lab.yaml", "rules: []").rules.empty()); }

TEST(RuleFile, ErrorsNameTheLineTheValueAndTheWayOut) {
  EXPECT_EQ(ErrorOf("rules:\n  - {name: a, value: compresion, above: 1}"),
            "--alarms=lab.yaml: line 2: value: compresion: expected ratio, class, exposure, "
            "compression, margin, loss or stale");
  EXPECT_EQ(ErrorOf("rules:\n  - name: a\n    value: margin\n    above: 1"),
            "--alarms=lab.yaml: line 4: unknown key 'above'; expected name, value, below, band, "
            "for, over_after, priority or latch");
  EXPECT_EQ(ErrorOf("rules:\n  - {name: a, value: loss}"),
            "--alarms=lab.yaml: line 2: a: above is missing");
  EXPECT_EQ(ErrorOf("rules:\n  - {name: a, value: loss, above: 2}"),
            "--alarms=lab.yaml: line 2: above: 2: expected a number from 0 to 1");
  EXPECT_EQ(ErrorOf("rules:\n  - {name: a, value: loss, above: .nan}"),
            "--alarms=lab.yaml: line 2: above: .nan: expected a number from 0 to 1");
  EXPECT_EQ(ErrorOf("rules:\n  - {name: a, value: loss, above: 0.1, joint: l5_s1}"),
            "--alarms=lab.yaml: line 2: unknown key 'joint'; expected name, value, above, band, "
            "for, over_after, priority or latch");
  EXPECT_THAT(ErrorOf("rules:\n  - {name: a, value: ratio, above: 1, joint: l5s1}"),
              HasSubstr("line 2: joint: l5s1: expected l5_s1,"));
  EXPECT_THAT(ErrorOf("rules:\n- {name: lost, value: stale, above: 1}"),
              HasSubstr("this rule is always there"));
  EXPECT_THAT(ErrorOf("rules: []\nwebhook: file:///etc/passwd"), HasSubstr("line 2: webhook"));
  EXPECT_THAT(ErrorOf("rules: []\nrules: []"), HasSubstr("given twice"));
  EXPECT_THAT(ErrorOf("rules: [a]"), HasSubstr("expected a rule, such as"));
  EXPECT_THAT(ErrorOf("42"), HasSubstr("expected 'rules:'"));
  EXPECT_THAT(ErrorOf("rules: ["), HasSubstr("--alarms=lab.yaml: line"));
  std::string many = "rules:\n";
  for (int i = 0; i < 65; ++i) {
    many += "  - {name: n" + std::to_string(i) + ", value: stale, above: 1}\n";
  }
  EXPECT_THAT(ErrorOf(many), HasSubstr("65 rules are more than 64"));
}

TEST(RuleFile, AFileThatCannotBeReadIsNamed) {
  try {
    LoadRules("/missing/rules.yaml");
    FAIL();
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(),
                 "--alarms=/missing/rules.yaml: cannot read this file; expected a file of rules "
                 "(docs/alarms.md) or default");
  }
}

TEST(RuleFile, ReadsAFile) {
  const TempFolder folder;
  std::ofstream(folder / "rules.yaml") << kDefaultRules;
  EXPECT_EQ(LoadRules((folder / "rules.yaml").string()).rules.size(), 4u);
}

}  // namespace
}  // namespace kinescope::alarms
