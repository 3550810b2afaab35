// What may lie in a folder of golden cases, several who accept there at a time, and results of
// earlier runs.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <string>
#include <vector>

#include "tests/process.h"
#include "tests/system/golden_fixture.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"

namespace kinescope::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr char kSmall[] = "source: demo:lift\ntime: 1\nsize: 64x64\n";

TEST_F(GoldenCheck, RefusesFilesThatCannotBeCasesAndComparesTheOthers) {
  WriteCase(std::string(230, 'n'), kSmall);
  WriteCase("-dash", kSmall);
  ASSERT_EQ(::mkfifo((case_ / "pipe.yaml").c_str(), 0600), 0);
  const ProgramResult result = Check({"--junit", case_ / "out/junit.xml"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("its name has 230 bytes"),
                                HasSubstr("a name that begins with '-' is taken for an option"),
                                HasSubstr("pipe.yaml: is no file"),
                                HasSubstr("bend                     same")));
  EXPECT_TRUE(fs::exists(case_ / "out/junit.xml"));
  EXPECT_TRUE(fs::exists(case_ / "out/report.html"));
}

// As several jobs of a CI server do.
TEST_F(GoldenCheck, SharesCasesAndFindingsAmongProcesses) {
  for (const char* name : {"one", "two", "three", "four"}) WriteCase(name, kSmall);
  ASSERT_EQ(Golden({"update", case_}).exit_code, 0);
  fs::copy(case_ / "one.png", case_ / "of_nothing.png");
  std::map<std::string, int> found;
  int failed = 0;
  for (const char* shard : {"1/3", "2/3", "3/3"}) {
    const ProgramResult result = Check({"--shard", shard});
    EXPECT_THAT(result.out, HasSubstr(std::string("Shard ") + shard + ": "));
    failed += result.exit_code;
    for (const char* name : {"bend", "one", "two", "three", "four", "of_nothing"}) {
      found[name] += ("\n" + result.out).find(std::string("\n") + name) != std::string::npos;
    }
  }
  EXPECT_EQ(failed, 1) << "only the share of the picture that belongs to no case";
  for (const auto& [name, count] : found) EXPECT_EQ(count, 1) << name;
}

TEST_F(GoldenCheck, HasNothingToCompareInAnEmptyShare) {
  int empty = 0;
  for (const char* shard : {"1/2", "2/2"}) {
    const ProgramResult result = Check({"--shard", shard, "--junit", case_ / "out/junit.xml"});
    EXPECT_EQ(result.exit_code, 0) << result.out;
    EXPECT_TRUE(fs::exists(case_ / "out/junit.xml"));
    empty += result.out == fmt::format("Shard {}: There is no picture to compare\n", shard);
  }
  EXPECT_EQ(empty, 1);
}

// Variables that a CI server has not set must not let every job compare everything.
TEST_F(GoldenCheck, RefusesAShareWithoutNumbers) {
  for (const char* shard : {"/", "", "0/2", "3/2"}) {
    const ProgramResult result = Check({"--shard", shard});
    EXPECT_EQ(result.exit_code, 2) << shard;
    EXPECT_THAT(result.err, AllOf(HasSubstr("shard"), HasSubstr("K/N"))) << shard;
  }
}

TEST_F(GoldenCheck, LosesNothingThatSeveralAcceptAtATime) {
  const std::vector<std::string> names = {"one", "two", "three"};
  for (const std::string& name : names) WriteCase(name, kSmall);
  ASSERT_EQ(Check().exit_code, 2);
  std::vector<std::future<ProgramResult>> all;
  for (const std::string& name : names) {
    all.push_back(std::async(std::launch::async, [this, name] {
      return Golden({"accept", case_ / "out", name});
    }));
  }
  for (auto& each : all) EXPECT_EQ(each.get().exit_code, 0);
  EXPECT_EQ(Check().exit_code, 0) << Check().out;
}

TEST_F(GoldenCheck, AcceptsTheOthersWhenAPictureCannotBeWritten) {
  WriteCase("a_blocked", kSmall);
  WriteCase("z_last", kSmall);
  fs::create_directory(case_ / "a_blocked.png");
  const ProgramResult result = Golden({"update", case_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("a_blocked                NOT ACCEPTED"), HasSubstr("Is a directory"),
                    HasSubstr("z_last                   accepted for the first time")));
  fs::remove(case_ / "a_blocked.png");
  fs::remove(case_ / "a_blocked.yaml");
  EXPECT_EQ(Check().exit_code, 0);
}

// A CI server would publish them as those of this run.
TEST_F(GoldenCheck, LeavesNoResultsOfAnEarlierRun) {
  const fs::path junit = case_ / "out/junit.xml", summary = case_ / "out/summary.md";
  const std::vector<std::string> files = {"--junit", junit, "--summary", summary};
  ASSERT_EQ(Check(files).exit_code, 0);
  std::ofstream(case_ / "golden.lock") << "<<<<<<< HEAD\n{}\n=======\n";
  const ProgramResult result = Check(files);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("merge conflict"));
  EXPECT_THAT(ReadFile(junit), AllOf(HasSubstr("errors=\"1\""), HasSubstr("merge conflict")));
  EXPECT_THAT(ReadFile(summary), HasSubstr("merge conflict"));
  EXPECT_FALSE(fs::exists(case_ / "out/report.html"));
  EXPECT_FALSE(fs::exists(case_ / "out/run.json"));
}

// Ctrl-C after an hour.
TEST_F(GoldenCheck, ReportsWhatWasComparedBeforeItWasInterrupted) {
  WriteCase("z_long", "source: demo:lift\nseconds: 3600\nfps: 30\nevery: 600\nsize: 640x360\n");
  const fs::path out = case_ / "out";
  Process check(
      {KinescopePath(), "golden", "check", case_, "--out", out, "--junit", out / "junit.xml"});
  ASSERT_EQ(RestOfLine(check, "bend                     "), "same");
  check.Signal(SIGINT);
  EXPECT_EQ(check.WaitForEnd(), 2);
  EXPECT_THAT(ReadFile(out / "junit.xml"),
              AllOf(HasSubstr("name=\"bend\""), HasSubstr("interrupted after 1 of 2 cases")));
  EXPECT_TRUE(fs::exists(out / "report.html"));
}

TEST_F(GoldenCheck, LeavesNoPicturesAmongTheCases) {
  const ProgramResult result = Golden({"check", case_, "--out", case_});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.err, HasSubstr("is the folder of the cases"));
  EXPECT_EQ(Check().exit_code, 0);
}

TEST_F(GoldenCheck, AcceptsNoSceneThatShowsNothing) {
  WriteCase("away",
            "source: demo:lift\ncamera: '0,0,1:10,10,1.2'\nno_overlays: true\nsize: 64x64\n");
  const ProgramResult result = Golden({"update", case_, "away"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_THAT(result.out, AllOf(HasSubstr("NOT ACCEPTED"), HasSubstr("shows no")));
}

}  // namespace
}  // namespace kinescope::testing
