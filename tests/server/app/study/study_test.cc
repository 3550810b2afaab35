#include "server/app/study/study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/system/errors.h"
#include "server/app/study/study_text.h"
#include "server/app/study/trial_loads.h"
#include "server/table/load_rows.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::TempFolder;
using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

json JointNamed(std::string_view name, int high) {
  return {{"joint", name},
          {"samples", {{"unknown", 0}, {"low", 100 - high}, {"medium", 0}, {"high", high}}},
          {"above",
           {{{"limit", 0.3}, {"longest_s", 1}, {"rises", 1}, {"rises_per_min", 6}},
            {{"limit", 0.6}, {"longest_s", 0.5}, {"rises", 2}, {"rises_per_min", 12}}}},
          {"p10", 0.1},
          {"p50", 0.2},
          {"p90", 0.7},
          {"peak_ratio", 0.9},
          {"peak_time_s", 1.5},
          {"peak_channel", "flexion"},
          {"peak_moment_Nm", nullptr}};
}

json LoadsWith(int high) {
  json exposure = json::array();
  for (std::size_t i = 0; i < 15; ++i) exposure.push_back(JointNamed(ScoredName(i), high));
  return {
      {"schema", "urn:kinescope:loads:1"},
      {"program", "kinescope 0"},
      {"source", "S1.mvnx"},
      {"options", {{"mass", 80}, {"class_limits", "0.3,0.6"}, {"floor_z", nullptr}}},
      {"people",
       {{{"person", 0},
         {"name", "Ann"},
         {"samples", 100},
         {"seconds", 2.5},
         {"mass_kg", 80},
         {"height_m", 1.8},
         {"facts",
          {{{"name", "sex"}, {"value", "female"}, {"is_assumed", false}},
           {{"name", "hand load"}, {"value", "nothing"}, {"is_assumed", true}}}},
         {"exposure", exposure},
         {"l5_s1_compression_N",
          {{"mean", 1000}, {"most", 3500}, {"above", {{{"limit", 3400}, {"seconds", 0.25}}}}}}}}}};
}

// As `kinescope loads` writes it: the samples before the rest.
std::string AsWritten(const json& loads, const std::string& samples) {
  json rest = loads;
  rest.erase("schema");
  std::string text = R"({"schema":"urn:kinescope:loads:1","columns":["time_s"],"samples":[)" +
                     samples + R"(],"inputs":[],)";
  return text + rest.dump().substr(1) + "\n";
}

class StudyFiles : public ::testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  const TempFolder folder_;
};

TEST_F(StudyFiles, LoadsAreReadFromTheEndOfAFileOrFromAnotherProgramsText) {
  // A sample that looks as if the samples ended there.
  const std::string trap = R"(["],\"inputs\":[],\"people\":[]"])";
  std::string many = trap;
  while (many.size() < 300'000) many += "," + trap;
  const std::string text = AsWritten(LoadsWith(20), many);
  for (const std::string& path :
       {Write("own.json", text), Write("other.json", json::parse(text).dump(1))}) {
    const TrialLoads trial = ReadTrialLoads(path);
    EXPECT_EQ(trial.source, "S1.mvnx");
    EXPECT_EQ(trial.options,
              (std::map<std::string, std::string>{{"mass", "80"}, {"class_limits", "0.3,0.6"}}));
    ASSERT_EQ(trial.people.size(), 1U);
    const PersonLoads& person = trial.people[0];
    ASSERT_EQ(person.joints.size(), 15U);
    EXPECT_EQ(person.joints[3].Percent(LoadClass::kHigh), 20);
    EXPECT_EQ(person.joints[3].rises, 2U);
    EXPECT_EQ(person.joints[3].longest_high_secs, 0.5);
    EXPECT_TRUE(std::isnan(person.joints[3].peak_moment_Nm));
    EXPECT_EQ(person.compression_most_N, 3500);
    EXPECT_EQ(person.compression_above_secs, 0.25);
    EXPECT_EQ(person.sex, "female");
    EXPECT_EQ(person.hand_load, "") << "it was assumed";
  }
  json with_option = LoadsWith(20);
  with_option["people"][0]["facts"][1]["is_assumed"] = false;
  with_option["options"]["hand_load"] = "";
  EXPECT_EQ(ReadTrialLoads(Write("b.json", with_option.dump())).people[0].hand_load, "nothing");
  with_option["options"]["hand_load"] = "both:5";
  EXPECT_EQ(ReadTrialLoads(Write("c.json", with_option.dump())).people[0].hand_load, "both:5");
}

TEST_F(StudyFiles, WhatIsNoFileOfLoadsIsNamed) {
  const auto problem_of = [](const std::string& path) {
    try {
      ReadTrialLoads(path);
    } catch (const SourceError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(problem_of(Write("a.json", "{}")),
              HasSubstr("a.json: expected a JSON file of kinescope loads"));
  EXPECT_THAT(problem_of(Write("b.json", R"({"schema":"urn:kinescope:loads:1","columns":[)")),
              HasSubstr("b.json: "));
  json without = LoadsWith(1);
  without.erase("people");
  EXPECT_THAT(problem_of(Write("c.json", AsWritten(without, ""))), HasSubstr("people"));
}

TEST_F(StudyFiles, FilesOfLoadsAreTrialsWithTheLabelsOfTheirNames) {
  Write("P1_6 kg_1.json", AsWritten(LoadsWith(10), ""));
  Write("P1_14 kg_1.json", AsWritten(LoadsWith(30), ""));
  json other = LoadsWith(50);
  other["options"]["class_limits"] = "0.4,0.7";
  Write("P2_14 kg_1.json", AsWritten(other, ""));
  Write("P3_14 kg_1.json", "{\"schema\":\"urn:kinescope:loads:1\",");
  StudySettings settings;
  settings.paths = {(folder_ / "*.json").string()};
  settings.labels.Parse("{person}_{condition}_{trial}");
  const Study study = ReadStudy(settings, [](std::size_t) {});
  EXPECT_THAT(study.People(), ElementsAre("P1", "P2", "P3"));
  EXPECT_THAT(study.Conditions(), ElementsAre("6 kg", "14 kg"));
  EXPECT_EQ(study.with_loads(), 3U);
  ASSERT_EQ(study.failures.size(), 1U);
  EXPECT_EQ(study.failures[0].id, "P3_14 kg_1");
  EXPECT_EQ(HeadlineOf(study), "4 trials of 3 people in 2 conditions: 3 with loads, 1 job failed");
  EXPECT_THAT(DifferencesOf(study),
              ElementsAre("Trials differ in class_limits: 0.3,0.6 (2 trials), 0.4,0.7 (1 trial)"));
  EXPECT_THAT(TextOf(study), HasSubstr("L5/S1                       10.0          40.0     +30.0"));
}

TEST(KindsOfReasons, LeaveOutWhatDiffersFromJobToJob) {
  EXPECT_EQ(KindOfReason("trials/S07_1.mvnx:48211: file ends inside <frame>: 412 of 720 samples"),
            "file ends inside <frame>: … of … samples");
  EXPECT_EQ(KindOfReason("no load is known"), "no load is known");
  EXPECT_EQ(KindOfReason(""), "");
  EXPECT_EQ(KindOfReason("S1.mvnx 5"), "…");
}

}  // namespace
}  // namespace kinescope::app
