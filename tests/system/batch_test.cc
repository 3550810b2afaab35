// `kinescope batch` and `kinescope jobs` as users start them.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/folders.h"
#include "tests/shared_data.h"
#include "tests/system/kinescope_path.h"
#include "tests/system/kinescope_program.h"
#include "tests/system/reader_of.h"
#include "tests/system/run_program.h"
#include "tests/temp_folder.h"

namespace kinescope {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::Kinescope;
using ::testing::Not;
using testing::ProgramResult;
using testing::ReadFile;
using testing::TempFolder;

class Batch : public ::testing::Test {
 protected:
  std::string In(const std::string& name) const { return (folder_ / name).string(); }

  json Picture(const std::string& id, const std::string& pose = "pose:n_pose") const {
    return {{"id", id},
            {"command", "render"},
            {"options", {{"source", pose}, {"out", In(id + ".png")}, {"size", "64x64"}}}};
  }
  json Loads(const std::string& id) const {
    return {{"id", id},
            {"command", "loads"},
            {"labels", {{"person", "P1"}}},
            {"options", {{"source", "demo:lift"}, {"seconds", 0.2}, {"csv", In(id + ".csv")}}}};
  }

  void WriteList(const std::vector<json>& jobs) const {
    std::ofstream file(In("jobs.jsonl"));
    for (const json& job : jobs)
      file << (job.is_string() ? job.get<std::string>() : job.dump()) << '\n';
  }

  ProgramResult Run(std::vector<std::string> arguments = {}) const {
    arguments.insert(arguments.begin(), {"batch", In("jobs.jsonl")});
    return Kinescope(arguments);
  }

  std::vector<json> Results(const std::string& name = "jobs.results.jsonl") const {
    std::ifstream file(In(name));
    std::vector<json> results;
    for (std::string line; std::getline(file, line);) results.push_back(json::parse(line));
    return results;
  }
  // State by id; a job with two lines is a failure.
  std::map<std::string, std::string> States() const {
    std::map<std::string, std::string> states;
    for (const json& result : Results()) {
      const bool is_new = states.emplace(result.at("id"), result.at("state")).second;
      EXPECT_TRUE(is_new) << result;
    }
    return states;
  }

  // A job whose recording is a named pipe waits for a writer.
  json JobThatWaits(const std::string& id) const {
    EXPECT_EQ(::mkfifo(In(id + ".mvnx").c_str(), 0600), 0);
    return Picture(id, In(id + ".mvnx"));
  }

  const TempFolder folder_;
};

TEST_F(Batch, DoesJobsOfEveryCommand) {
  const json convert = {
      {"id", "c"},
      {"command", "convert"},
      {"options", {{"source", "demo:lift"}, {"seconds", 0.1}, {"out", {In("c.csv")}}}}};
  const json golden = {
      {"id", "g"},
      {"command", "golden"},
      {"options",
       {{"folder", kinescope::testing::InSourceTree("docs/golden_example/golden").string()},
        {"out", In("golden")}}}};
  WriteList({Picture("p"), Loads("l"), convert, golden});
  const ProgramResult result = Run();
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("4 jobs: 4 complete, 0 failed"));
  const std::vector<json> results = Results();
  ASSERT_EQ(results.size(), 4u);
  for (const json& each : results) {
    EXPECT_EQ(each.at("state"), "done") << each;
    EXPECT_GT(each.at("seconds"), 0);
    EXPECT_GT(each.at("cpu_seconds"), 0);
    EXPECT_GT(each.at("peak_memory_bytes"), 10'000'000);
    EXPECT_LT(each.at("peak_memory_bytes"), 300'000'000);
    for (const json& output : each.at("outputs")) EXPECT_TRUE(fs::exists(output.at("path")));
  }
  EXPECT_EQ(results[1].at("labels").at("person"), "P1");
  EXPECT_EQ(results[0].at("outputs").size(), 2u);  // with its record
}

// A disk of `kilobytes` at `folder`, on which the list is done, and then `after`.
ProgramResult OnSmallDisk(const fs::path& folder, int kilobytes, const std::string& list,
                          const std::string& after) {
  const std::string script = fmt::format(
      "mount -t tmpfs -o size={0}k none '{1}' && {{ '{2}' batch '{3}'; code=$?; {4}; exit $code; "
      "}}",
      kilobytes, folder.string(), testing::KinescopePath(), list, after);
  return testing::RunProgram({"/usr/bin/unshare", "-rm", "/bin/bash", "-c", script});
}

TEST_F(Batch, NamesJobsWhoseDiskIsFullAndDoesTheOthers) {
  if (!testing::CanMount()) GTEST_SKIP() << "unshare -rm is not permitted here";
  fs::create_directory(In("disk"));
  json large = Loads("large"), small = Loads("small"), elsewhere = Loads("elsewhere");
  large["options"].update({{"csv", In("disk/large.csv")}, {"seconds", 5}});
  small["options"]["csv"] = In("disk/small.csv");
  small["options"]["seconds"] = 0.02;
  WriteList({large, small, elsewhere});
  const ProgramResult result =
      OnSmallDisk(In("disk"), 64, In("jobs.jsonl"), fmt::format("ls '{}'", In("disk")));
  EXPECT_EQ(result.exit_code, 1) << result.out << result.err;
  EXPECT_EQ(States(), (std::map<std::string, std::string>{
                          {"large", "failed"}, {"small", "done"}, {"elsewhere", "done"}}));
  for (const json& each : Results()) {
    if (each.at("id") != "large") continue;
    EXPECT_THAT(each.at("reason"), AllOf(HasSubstr("large.csv"), HasSubstr("No space left")));
  }
  EXPECT_THAT(result.out, AllOf(HasSubstr("small.csv"), Not(HasSubstr("disk/large.csv.part"))));
  EXPECT_THAT(result.out, HasSubstr("--retry failed")) << "it does not say what to do next";
}

// Nobody would know what has been done.
TEST_F(Batch, SaysThatResultsAreNotThereWhenTheirDiskIsFull) {
  if (!testing::CanMount()) GTEST_SKIP() << "unshare -rm is not permitted here";
  fs::create_directory(In("disk"));
  std::vector<json> jobs;
  for (int i = 0; i < 20; ++i) {
    jobs.push_back(Loads(std::to_string(i)));
    jobs.back()["labels"]["person"] = std::string(150, 'p');
  }
  WriteList(jobs);
  fs::rename(In("jobs.jsonl"), In("list.jsonl"));
  const std::string results = In("disk/r.jsonl");
  const std::string script = fmt::format(
      "mount -t tmpfs -o size=8k none '{0}' && {{ '{1}' batch '{2}' --results '{3}'; code=$?; "
      "cp '{3}' '{4}'; mount -o remount,size=1m '{0}'; '{1}' batch '{2}' --results '{3}' --check; "
      "'{1}' batch '{2}' --results '{3}' && '{1}' batch '{2}' --results '{3}' --check; "
      "cp '{3}' '{5}'; exit $code; }}",
      In("disk"), testing::KinescopePath(), In("list.jsonl"), results, In("full.jsonl"),
      In("jobs.results.jsonl"));
  const ProgramResult result =
      testing::RunProgram({"/usr/bin/unshare", "-rm", "/bin/bash", "-c", script});
  EXPECT_NE(result.exit_code, 0);
  EXPECT_THAT(result.err, AllOf(HasSubstr("r.jsonl"), HasSubstr("No space left")));
  for (const json& each : Results("full.jsonl"))
    EXPECT_EQ(each.at("state"), "done") << "half a line";
  EXPECT_LT(Results("full.jsonl").size(), 20u);
  EXPECT_EQ(States().size(), 20u) << "with room, the same command goes on";
  EXPECT_THAT(result.out, HasSubstr("20 of 20 jobs complete"));
}

TEST_F(Batch, WritesTheSameBytesAsTheCommands) {
  json clip = Picture("clip", "demo:lift");
  clip["options"].update({{"out", In("clip.mp4")}, {"seconds", 0.5}});
  WriteList({Picture("a"), clip, Picture("b", "pose:right_elbow=90")});
  ASSERT_EQ(Run().exit_code, 0);
  const std::vector<std::vector<std::string>> alone = {
      {"pose:n_pose", "a.png"}, {"pose:right_elbow=90", "b.png"}, {"demo:lift", "clip.mp4"}};
  fs::create_directory(In("alone"));
  for (const auto& words : alone) {
    std::vector<std::string> arguments = {
        "render", words[0], "--out", In("alone/" + words[1]), "--size", "64x64", "--no_sidecar"};
    if (words[1] == "clip.mp4") arguments.insert(arguments.end(), {"--seconds", "0.5"});
    ASSERT_EQ(Kinescope(arguments).exit_code, 0);
    EXPECT_EQ(ReadFile(In("alone/" + words[1])), ReadFile(In(words[1]))) << words[1];
  }
}

TEST_F(Batch, NamesTheLinesThatAreWrongAndDoesTheRest) {
  json other_output = Picture("other");
  other_output["options"]["out"] = In("good.png");
  json unknown = Picture("unknown");
  unknown["options"]["camra"] = "front";
  WriteList({Picture("good"), "{broken", Picture("good"), other_output, unknown,
             Picture("gone", In("gone.mvnx")), Picture("last")});
  const ProgramResult result = Run();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, AllOf(HasSubstr("jobs.jsonl:2: not valid JSON"),
                                HasSubstr("jobs.jsonl:3: id 'good' is already that of line 1")));
  EXPECT_THAT(result.out,
              AllOf(HasSubstr("jobs.jsonl:4): out=" + In("good.png") +
                              ": is also written by job 'good' in line 1"),
                    HasSubstr("jobs.jsonl:5): unknown option 'camra'; nearest: camera"),
                    HasSubstr("jobs.jsonl:6): source '" + In("gone.mvnx") + "': file not found"),
                    HasSubstr("5 jobs: 2 complete, 3 failed")));
  EXPECT_THAT(States(), ::testing::UnorderedElementsAre(
                            ::testing::Pair("good", "done"), ::testing::Pair("other", "failed"),
                            ::testing::Pair("unknown", "failed"), ::testing::Pair("gone", "failed"),
                            ::testing::Pair("last", "done")));
}

TEST_F(Batch, DoesNothingTwice) {
  WriteList({Picture("a"), Loads("l")});
  ASSERT_EQ(Run().exit_code, 0);
  const std::string results = ReadFile(In("jobs.results.jsonl"));
  const ProgramResult again = Run();
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_THAT(again.out, HasSubstr("2 jobs: 2 complete (2 of them before), 0 failed"));
  EXPECT_EQ(ReadFile(In("jobs.results.jsonl")), results);
}

TEST_F(Batch, KeepsPicturesThatAreUpToDate) {
  WriteList({Picture("a")});
  ASSERT_EQ(Run().exit_code, 0);
  ASSERT_EQ(Run({"--results", In("other.jsonl")}).exit_code, 0);
  EXPECT_EQ(Results("other.jsonl").at(0).at("state"), "kept");
}

TEST_F(Batch, DoesAgainWhatHasChanged) {
  WriteList({Picture("a"), Picture("b"), Picture("c")});
  ASSERT_EQ(Run().exit_code, 0);
  fs::remove(In("a.png"));
  std::ofstream(In("b.png"), std::ios::app) << "x";
  json changed = Picture("c", "pose:t_pose");
  WriteList({Picture("a"), Picture("b"), changed, Picture("d")});
  const ProgramResult check = Run({"--check"});
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_THAT(check.out, AllOf(HasSubstr("outdated    a (" + In("jobs.jsonl") +
                                         ":1): " + In("a.png") + " is missing"),
                               HasSubstr("outdated    b"), HasSubstr("b.png has changed since"),
                               HasSubstr("outdated    c"), HasSubstr("the job has changed since"),
                               HasSubstr("missing     d"), HasSubstr("0 of 4 jobs complete")));
  EXPECT_FALSE(fs::exists(In("d.png")));
  EXPECT_EQ(Run().exit_code, 0);
  EXPECT_EQ(States().size(), 4u);
  EXPECT_EQ(Run({"--check"}).exit_code, 0);
}

// A copy has other times, but the same content.
TEST_F(Batch, ComparesContentWhereOnlyTheTimeHasChanged) {
  WriteList({Picture("a")});
  ASSERT_EQ(Run().exit_code, 0);
  fs::last_write_time(In("a.png"), fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_EQ(Run({"--check"}).exit_code, 0);
}

TEST_F(Batch, RepeatsWhatFailedOnlyWhenTold) {
  WriteList({Picture("a", In("late.mvnx"))});
  EXPECT_EQ(Run().exit_code, 1);
  const auto copy = [&] {
    const ProgramResult made =
        Kinescope({"convert", "demo:lift", "--seconds", "0.1", "--out", In("late.mvnx")});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  };
  copy();
  EXPECT_EQ(Run().exit_code, 1);
  EXPECT_EQ(States().at("a"), "failed");
  EXPECT_EQ(Run({"--retry", "failed"}).exit_code, 0);
  EXPECT_EQ(States().at("a"), "done");
  EXPECT_EQ(Results().at(0).at("attempts"), 2);
}

TEST_F(Batch, SharesJobsSoThatEachIsDoneOnce) {
  std::vector<json> jobs;
  for (int i = 0; i < 6; ++i) jobs.push_back(Loads("job" + std::to_string(i)));
  WriteList(jobs);
  std::set<std::string> done;
  for (int k = 1; k <= 3; ++k) {
    const std::string share = std::to_string(k);
    ASSERT_EQ(Run({"--shard", share + "/3"}).exit_code, 0);
    for (const json& each : Results("jobs.results." + share + "-of-3.jsonl")) {
      EXPECT_TRUE(done.insert(each.at("id")).second) << each;
    }
  }
  EXPECT_EQ(done.size(), jobs.size());
  const ProgramResult check = Run({"--check"});
  EXPECT_EQ(check.exit_code, 0) << check.out;
  EXPECT_THAT(check.out, HasSubstr("6 of 6 jobs complete"));
  EXPECT_EQ(Run({"--check", "--results", In("jobs.results.*.jsonl")}).exit_code, 0);
}

TEST_F(Batch, SucceedsWithAnEmptyShare) {
  WriteList({Loads("one")});
  std::vector<int> complete;
  for (const char* const share : {"1/2", "2/2"}) {
    const ProgramResult result = Run({"--shard", share});
    EXPECT_EQ(result.exit_code, 0);
    complete.push_back(result.out.find("none of the 1 job is in shard") == std::string::npos);
  }
  EXPECT_THAT(complete, ::testing::UnorderedElementsAre(0, 1));
}

TEST_F(Batch, RefusesWhatIsNoShare) {
  WriteList({Loads("one")});
  for (const char* const share : {"17/16", "0/4", "/", "3", "1/0", "a/b", "-1/4"}) {
    testing::ExpectRefusal(Run({std::string("--shard=") + share}), "--shard=");
  }
  testing::ExpectRefusal(Run({"--shard="}), "--shard: value missing");  // never all of them
}

TEST_F(Batch, IsStoppedAndGoesOn) {
  std::vector<json> jobs = {Loads("first"), JobThatWaits("waits"), Loads("later")};
  WriteList(jobs);
  auto batch = std::async(std::launch::async, [&] { return Run(); });
  const int pipe =
      ::open(In("waits.mvnx").c_str(), O_WRONLY | O_CLOEXEC);  // returns when it is read
  ASSERT_GE(pipe, 0);
  const pid_t worker = testing::ReaderOf(In("waits.mvnx"));
  std::ifstream status("/proc/" + std::to_string(worker) + "/status");
  pid_t parent = 0;
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("PPid:", 0) == 0) parent = std::atoi(line.c_str() + 5);
  }
  ASSERT_GT(parent, 1);
  ASSERT_EQ(::kill(parent, SIGTERM), 0);
  const ProgramResult stopped = batch.get();
  ::close(pipe);
  EXPECT_EQ(stopped.exit_code, 143) << stopped.err;
  EXPECT_THAT(stopped.out, HasSubstr("3 jobs: 1 complete, 0 failed, 2 interrupted"));
  EXPECT_EQ(States().at("waits"), "interrupted");
  EXPECT_EQ(States().at("later"), "interrupted");

  fs::remove(In("waits.mvnx"));
  ASSERT_EQ(
      Kinescope({"convert", "demo:lift", "--seconds", "0.1", "--out", In("waits.mvnx")}).exit_code,
      0);
  EXPECT_EQ(Run().exit_code, 0);
  for (const json& result : Results()) {
    EXPECT_EQ(result.at("state"), "done");
    EXPECT_EQ(result.at("attempts"), result.at("id") == "waits" ? 2 : 1) << result;
  }
}

// Slurm signals batch and workers at once, in any order.
TEST_F(Batch, DoesNotCallJobsFailedWhoseProcessWasStopped) {
  WriteList({JobThatWaits("waits"), Loads("later")});
  auto batch = std::async(std::launch::async, [&] { return Run(); });
  const int pipe = ::open(In("waits.mvnx").c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  ASSERT_EQ(::kill(testing::ReaderOf(In("waits.mvnx")), SIGTERM), 0);
  const ProgramResult result = batch.get();
  ::close(pipe);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, HasSubstr("2 jobs: 1 complete, 0 failed, 1 interrupted"));
  EXPECT_EQ(States().at("waits"), "interrupted");
}

TEST_F(Batch, DoesTheOthersWhenAJobCrashes) {
  WriteList({JobThatWaits("crashes"), Loads("fine")});
  auto batch = std::async(std::launch::async, [&] { return Run(); });
  const int pipe = ::open(In("crashes.mvnx").c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_GE(pipe, 0);
  ASSERT_EQ(::kill(testing::ReaderOf(In("crashes.mvnx")), SIGSEGV), 0);
  ::close(pipe);
  const ProgramResult result = batch.get();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("its process ended with signal 11"),
                                HasSubstr("2 jobs: 1 complete, 1 failed")));
}

TEST_F(Batch, EndsAJobThatHangs) {
  WriteList({JobThatWaits("hangs"), Loads("fine")});
  const ProgramResult result = Run({"--job_limit_secs", "3"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.out, AllOf(HasSubstr("was not finished within 3 s (--job_limit_secs)"),
                                HasSubstr("2 jobs: 1 complete, 1 failed")));
}

TEST_F(Batch, NamesResultsOfAnotherList) {
  WriteList({Loads("theirs")});
  ASSERT_EQ(Run().exit_code, 0);
  WriteList({Loads("ours")});
  const ProgramResult result = Run();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("jobs.results.jsonl:1: job 'theirs' is not in " +
                                    In("jobs.jsonl") + ": a result of another list"));
  EXPECT_THAT(States(), ::testing::UnorderedElementsAre(::testing::Pair("theirs", "done"),
                                                        ::testing::Pair("ours", "done")));
}

TEST_F(Batch, DropsAnUnfinishedLastLineAndSaysSo) {
  WriteList({Loads("a"), Loads("b")});
  ASSERT_EQ(Run().exit_code, 0);
  const std::string results = ReadFile(In("jobs.results.jsonl"));
  std::ofstream(In("jobs.results.jsonl")) << results.substr(0, results.size() - 30);
  const ProgramResult result = Run();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("its last line is not finished"));
  EXPECT_EQ(States().size(), 2u);
}

TEST_F(Batch, LetsOneProcessWriteResults) {
  WriteList({JobThatWaits("waits")});
  auto first = std::async(std::launch::async, [&] { return Run(); });
  const int pipe = ::open(In("waits.mvnx").c_str(), O_WRONLY | O_CLOEXEC);
  testing::ExpectRefusal(Run(), "another process writes these results");
  ::close(pipe);
  EXPECT_EQ(first.get().exit_code, 1);  // an empty recording
}

TEST_F(Batch, WritesNothingBesideItsOutputs) {
  json job = Loads("a");
  WriteList({job});
  ASSERT_EQ(Run().exit_code, 0);
  EXPECT_THAT(folder_.Names(), ElementsAre("a.csv", "jobs.jsonl", "jobs.results.jsonl"));
}

TEST_F(Batch, PrintsResultsForPipes) {
  WriteList({Loads("a")});
  const ProgramResult result = Run({"--results", "-"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(json::parse(result.out).at("state"), "done");
  EXPECT_EQ(result.err, "");
}

class JobLists : public Batch {};

TEST_F(JobLists, HaveAJobForEachRecordingAndCamera) {
  for (const char* const name : {"S1_lift_1.mvnx", "S2_walk_1.mvnx"})
    std::ofstream(In(name)) << "x";
  const ProgramResult result =
      Kinescope({"jobs", In("*.mvnx"), "--camera", "front,side", "--labels", "{person}_{task}_{n}",
                 "--out", In("{person}-{camera}.mp4")});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> ids;
  std::istringstream lines(result.out);
  for (std::string line; std::getline(lines, line);) ids.push_back(json::parse(line).at("id"));
  EXPECT_THAT(
      ids, ElementsAre("S1_lift_1-front", "S1_lift_1-side", "S2_walk_1-front", "S2_walk_1-side"));
  const json last = json::parse(result.out.substr(result.out.rfind("{\"id\"")));
  EXPECT_EQ(last.at("labels"), (json{{"n", "1"}, {"person", "S2"}, {"task", "walk"}}));
  EXPECT_EQ(last.at("options").at("out"), json::array({In("S2-side.mp4")}));
  EXPECT_EQ(last.at("options").at("camera"), "side");
}

TEST_F(JobLists, AreDoneByABatch) {
  ASSERT_EQ(
      Kinescope({"convert", "demo:lift", "--seconds", "0.2", "--out", In("take.mvnx")}).exit_code,
      0);
  const ProgramResult list = Kinescope(
      {"jobs", In("*.mvnx"), "--command=loads", "--json", In("{source}.json"), "--mass", "80"});
  ASSERT_EQ(list.exit_code, 0) << list.err;
  std::ofstream(In("jobs.jsonl")) << list.out;
  EXPECT_EQ(Run().exit_code, 0);
  EXPECT_EQ(json::parse(ReadFile(In("take.json"))).at("options").at("mass"), 80);
}

TEST_F(JobLists, NameWhatIsWrongInOneLine) {
  std::ofstream(In("a.mvnx")) << "x";
  fs::create_directory(In("sub"));
  std::ofstream(In("sub/a.mvnx")) << "x";
  const auto refuses = [&](std::vector<std::string> words, const std::string& named) {
    words.insert(words.begin(), "jobs");
    testing::ExpectRefusal(Kinescope(words), named);
  };
  refuses({}, "source is missing");
  refuses({In("*.bvh")}, "no such file");
  refuses({In("a.mvnx"), "--outt", "x"}, "unknown option '--outt'; nearest: out");
  refuses({In("a.mvnx"), "--out"}, "--out: value missing");
  refuses({In("a.mvnx"), "--out", In("a.xyz")}, "expected a name that ends in");
  refuses({In("a.mvnx"), In("sub/a.mvnx"), "--out", In("{folder}.png")},
          "two jobs have the id 'a'");
  refuses({In("a.mvnx"), In("sub/a.mvnx"), "--id={folder}-{source}", "--out", In("x.png")},
          "is also written by job");
  refuses({In("a.mvnx"), "--labels={person}_{n}", "--out", In("x.png")},
          "does not have the form --labels={person}_{n}");
  refuses({In("a.mvnx"), "--labels={a}{b}", "--out", In("x.png")}, "--labels={a}{b}: expected");
}

}  // namespace
}  // namespace kinescope
