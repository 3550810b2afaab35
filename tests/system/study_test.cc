// `kinescope study` as users start it, on results that `kinescope batch` wrote.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/csv_table.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::CsvTable;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;
using testing::ReadFile;
using testing::TempFolder;

class Study : public ::testing::Test {
 protected:
  std::string In(const std::string& name) const { return (folder_ / name).string(); }

  json Loads(const std::string& person, const std::string& condition, const std::string& kg) const {
    const std::string id = person + "_" + condition;
    return {
        {"id", id},
        {"command", "loads"},
        {"labels", {{"person", person}, {"condition", condition}, {"reason", "a\"b,c</script>"}}},
        {"options",
         {{"source", "demo:lift"},
          {"seconds", 1},
          {"mass", 80},
          {"hand_load", "both:" + kg},
          {"samples", "none"},
          {"json", In("loads " + id + ".json")}}}};
  }

  // Two people with two conditions, a clip of one of them, and a trial whose recording is missing.
  void DoJobs() const {
    json clip = Loads("P1", "light", "2");
    clip["id"] = "P1_light-front";
    clip["command"] = "render";
    clip["options"] = {
        {"source", "demo:lift"}, {"time", 0.5}, {"size", "64x64"}, {"out", In("P1.png")}};
    json lost = Loads("P2", "heavy", "12");
    lost["options"]["source"] = In("lost_17.mvnx");
    std::ofstream file(In("jobs.jsonl"));
    for (const json& job : {Loads("P1", "light", "2"), Loads("P1", "heavy", "12"),
                            Loads("P2", "light", "2"), lost, clip}) {
      file << job.dump() << '\n';
    }
    file.close();
    EXPECT_EQ(Kinescope({"batch", In("jobs.jsonl")}).exit_code, 1);
  }

  static json DataOf(const std::string& page) {
    const std::string start = "<script type=\"application/json\" id=\"data\">";
    const std::size_t from = page.find(start) + start.size();
    return json::parse(page.substr(from, page.find("</script>", from) - from));
  }

  const TempFolder folder_;
};

TEST_F(Study, ComparesConditionsAndSaysWhatFailed) {
  DoJobs();
  const ProgramResult result =
      Kinescope({"study", In("jobs.results.jsonl"), "--report", In("study.html"), "--csv",
                 In("study.csv"), "--title", "Lifts <1>"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out,
              HasSubstr("4 trials of 2 people in 2 conditions: 3 with loads, 1 job failed"));
  EXPECT_THAT(result.out, HasSubstr("kinescope batch " + In("jobs.jsonl") + " --retry failed"));

  const std::string page = ReadFile(In("study.html"));
  EXPECT_THAT(page, HasSubstr("<title>Lifts &#60;1&#62;</title>"));
  EXPECT_THAT(page, Not(HasSubstr("c</script>")));
  const json data = DataOf(page);
  ASSERT_EQ(data.at("trials").size(), 4U);
  EXPECT_EQ(data.at("failures").size(), 1U);
  EXPECT_THAT(data.at("failures")[0].at("reason"), HasSubstr("lost_17.mvnx"));
  // The picture belongs to the trial with the same labels.
  EXPECT_EQ(data.at("trials")[1].at("id"), "P1_light");
  EXPECT_EQ(
      data.at("trials")[1].at("files"),
      json::parse(
          R"([["loads","loads%20P1_light.json"],["picture","P1.png"],["record","P1.png.json"]])"));

  // What the page says is what `loads` said.
  const json loads = json::parse(ReadFile(In("loads P1_heavy.json")));
  EXPECT_TRUE(loads.at("samples").empty());
  EXPECT_TRUE(loads.at("columns").empty());
  const CsvTable csv(ReadFile(In("study.csv")));
  ASSERT_EQ(csv.rows.size(), 3U * 15 + 1);
  for (std::size_t i = 0; i < 15; ++i) {
    const json& joint = loads.at("people")[0].at("exposure")[i];
    ASSERT_EQ(csv.At(i, "trial"), "P1_heavy");
    EXPECT_EQ(csv.At(i, "joint"), joint.at("joint").get<std::string>());
    EXPECT_EQ(csv.At(i, "label_reason"), "a\"b,c</script>");
    EXPECT_EQ(std::stod(csv.At(i, "peak_ratio")), joint.at("peak_ratio").get<double>());
    const json& samples = joint.at("samples");
    const double all = loads.at("people")[0].at("samples").get<double>();
    EXPECT_NEAR(std::stod(csv.At(i, "high_pct")), 100 * samples.at("high").get<double>() / all,
                1e-9);
    EXPECT_NEAR(data.at("trials")[0].at("joints")[i][2].get<double>() / 100,
                100 * samples.at("high").get<double>() / all, 0.006);
  }
  EXPECT_EQ(csv.At(30, "state"), "failed");
  EXPECT_EQ(csv.At(30, "joint"), "");
}

TEST_F(Study, SameResultsGiveTheSameBytes) {
  DoJobs();
  for (const char* name : {"a.html", "b.html"}) {
    Kinescope({"study", In("jobs.results.jsonl"), "--report", In(name), "--title", "t"});
  }
  EXPECT_EQ(ReadFile(In("a.html")), ReadFile(In("b.html")));
}

TEST_F(Study, MissesJobsThatNobodyBegan) {
  DoJobs();
  std::ofstream(In("jobs.jsonl"), std::ios::app) << Loads("P3", "light", "2").dump() << '\n';
  const ProgramResult result = Kinescope({"study", In("jobs.results.jsonl")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(
      result.out,
      HasSubstr("5 trials of 3 people in 2 conditions: 3 with loads, 1 job failed, 1 job missing"));
}

TEST_F(Study, NamesWhatIsWrong) {
  DoJobs();
  ExpectRefusal(Kinescope({"study", In("none*.jsonl")}), "none*.jsonl': no such file");
  ExpectRefusal(Kinescope({"study", In("jobs.results.jsonl"), "--report", In("study.pdf")}),
                "study.pdf: expected a name that ends in .html");
  ExpectRefusal(Kinescope({"study", In("jobs.results.jsonl"), "--csv", In("jobs.results.jsonl")}),
                "jobs.results.jsonl");
  EXPECT_THAT(ReadFile(In("jobs.results.jsonl")), HasSubstr("P1_light"));

  std::ofstream(In("jobs.results.jsonl"), std::ios::app) << "{\"id\": 7}\n";
  std::ofstream(In("loads P2_light.json")) << "{\"schema\":\"urn:kinescope:loads:1\",";
  const ProgramResult result = Kinescope({"study", In("jobs.results.jsonl")});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("jobs.results.jsonl:6: not a result of a job"));
  EXPECT_THAT(result.out, HasSubstr("2 with loads, 2 jobs failed"));
  EXPECT_THAT(result.out, HasSubstr("loads P2_light.json: "));
}

TEST_F(Study, MovedWithItsResultsItIsWhole) {
  DoJobs();
  std::string results = ReadFile(In("jobs.results.jsonl"));
  const std::string here = folder_.path().string() + "/";
  for (std::size_t at = 0; (at = results.find(here, at)) != std::string::npos;)
    results.erase(at, here.size());
  std::ofstream(In("jobs.results.jsonl")) << results;
  EXPECT_THAT(Kinescope({"study", In("jobs.results.jsonl")}).out, HasSubstr("3 with loads"));
}

}  // namespace
}  // namespace kinescope
