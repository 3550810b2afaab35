#include "server/app/batch/results_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "core/system/errors.h"
#include "server/app/batch/one_core.h"
#include "tests/full_disk.h"
#include "tests/shared_data.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using kinescope::testing::ReadFile;
using kinescope::testing::SmallFilesOnly;
using kinescope::testing::TempFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

JobResult ResultNamed(const std::string& id) {
  JobResult result;
  result.id = id;
  result.command = "render";
  result.state = JobState::kDone;
  result.labels["person"] = "P\"1";
  result.secs = 1.25;
  result.cpu_secs = 1;
  result.peak_memory_bytes = 123'456'789;
  result.started_millis = 1'795'582'138'980;
  result.host = "node7";
  result.attempts = 2;
  result.inputs = {{"a.mvnx", 1, 100, 1'795'582'138'000'000'001}};
  result.outputs = {{"out", {"f/%05d.png", 30, 5000, 7}, "abc", DeclaredOutput::Kind::kNumbered}};
  result.warnings = {"the suit has no feet"};
  return result;
}

std::vector<std::string> IdsOf(const FoundResults& found) {
  std::vector<std::string> ids;
  for (const FoundResult& each : found.results) ids.push_back(each.result.id);
  return ids;
}

TEST(Results, AreReadAsTheyAreWritten) {
  const JobResult result = ResultNamed("a");
  const std::string line = ToLine(result);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  EXPECT_EQ(ToLine(ReadResult(line)), line);
  const JobResult read = ReadResult(line);
  EXPECT_EQ(read.started_millis, result.started_millis);
  EXPECT_EQ(read.inputs.at(0).modified_nanos, result.inputs.at(0).modified_nanos);
  EXPECT_EQ(read.outputs.at(0).kind, DeclaredOutput::Kind::kNumbered);
}

TEST(Results, NameLinesThatAreNone) {
  const TempFolder folder;
  std::ofstream(folder / "r.jsonl") << ToLine(ResultNamed("a")) << "\n{\"id\":\"b\"}\n"
                                    << ToLine(ResultNamed("c")) << '\n';
  const FoundResults found = ReadResults(folder / "r.jsonl");
  EXPECT_THAT(IdsOf(found), ElementsAre("a", "c"));
  EXPECT_THAT(found.faults, ElementsAre(HasSubstr("r.jsonl:2: not a result of a job")));
  EXPECT_FALSE(found.has_unfinished_line);
}

TEST(Results, KeepLinesOfOthersWhenSomeAreReplaced) {
  const TempFolder folder;
  const std::string path = folder / "r.jsonl";
  {
    ResultsFile file(path);
    file.Add(ResultNamed("a"));
    file.Add(ResultNamed("b"));
    file.KeepOnly({ReadResults(path).results.at(0).text});
    file.Add(ResultNamed("c"));
    file.Finish();
    EXPECT_THROW(ResultsFile{path}, UsageError);  // also of the file that has replaced it
  }
  EXPECT_THAT(IdsOf(ReadResults(path)), ElementsAre("a", "c"));
  EXPECT_THAT(folder.Names(), ElementsAre("r.jsonl"));
  const ResultsFile again(path);
}

TEST(Results, WaitForRoomOnTheDisk) {
  const TempFolder folder;
  const std::string path = folder / "r.jsonl";
  ResultsFile file(path);
  file.Add(ResultNamed("a"));
  {
    const SmallFilesOnly full(ReadFile(path).size() + 20);
    file.Add(ResultNamed("b"));
    EXPECT_THROW(file.Finish(), std::runtime_error);
    EXPECT_THAT(IdsOf(ReadResults(path)), ElementsAre("a"));  // no half of a line
  }
  file.Add(ResultNamed("c"));
  file.Finish();
  EXPECT_THAT(IdsOf(ReadResults(path)), ElementsAre("a", "b", "c"));
}

TEST(OneCore, IsAllThatAProcessUses) {
  const auto cores = [] {
    cpu_set_t set;
    CPU_ZERO(&set);
    ::sched_getaffinity(0, sizeof set, &set);
    return CPU_COUNT(&set);
  };
  EXPECT_EXIT(
      {
        UseOneCore();
        const bool is_one = cores() == 1;
        UseOneCore();  // chooses again
        std::_Exit(is_one && cores() == 1 ? 0 : 1);
      },
      ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace kinescope::app
