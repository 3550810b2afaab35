#include "server/app/batch/batch_state.h"

#include <fmt/format.h>

#include <filesystem>
#include <unordered_set>

#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "server/options/path_pattern.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;

JobStanding StandingOf(const Job& job, const FoundResult* found) {
  JobStanding standing;
  standing.job = &job;
  standing.found = found;
  if (found == nullptr) return standing;
  const JobResult& result = found->result;
  if (result.is_complete()) {
    standing.why = WhyStale(result, job);
    standing.standing = standing.why.empty() ? Standing::kComplete : Standing::kStale;
    return standing;
  }
  standing.why = result.reason;
  standing.standing =
      result.state == JobState::kFailed ? Standing::kFailed : Standing::kInterrupted;
  if (standing.standing == Standing::kFailed && result.digest != job.Digest()) {
    standing.standing = Standing::kStale;
    standing.why = "the job has changed since it failed";
  }
  return standing;
}

// "jobs" of "lists/jobs.jsonl.gz".
std::string StemOf(const std::string& list) {
  fs::path name = fs::path(list);
  for (const char* packed : {".gz", ".xz", ".zst", ".bz2", ".lz4"}) {
    if (name.extension() == packed) name.replace_extension();
  }
  return name.replace_extension().string();
}

}  // namespace

std::vector<JobStanding> StandingsOf(const JobList& list, const Shard& shard,
                                     const std::vector<FoundResults>& results) {
  std::unordered_map<std::string, const FoundResult*> newest;
  for (const FoundResults& file : results) {
    for (const FoundResult& each : file.results) {
      const FoundResult*& found = newest[each.result.id];
      if (found == nullptr || each.result.started_millis >= found->result.started_millis) {
        found = &each;
      }
    }
  }
  std::vector<JobStanding> standings;
  for (const Job& job : list.jobs) {
    if (!shard.Has(job.id)) continue;
    const auto found = newest.find(job.id);
    standings.push_back(StandingOf(job, found == newest.end() ? nullptr : found->second));
  }
  return standings;
}

std::vector<std::string> FaultsOf(const std::vector<FoundResults>& results, const JobList& list) {
  constexpr std::size_t kMostNamed = 5;
  std::unordered_set<std::string> ids;
  for (const Job& job : list.jobs) ids.insert(job.id);
  std::vector<std::string> faults;
  for (const FoundResults& file : results) {
    faults.insert(faults.end(), file.faults.begin(), file.faults.end());
    std::size_t foreign = 0;
    for (const FoundResult& each : file.results) {
      if (ids.count(each.result.id) > 0 || ++foreign > kMostNamed) continue;
      faults.push_back(fmt::format("{}:{}: job '{}' is not in {}: a result of another list",
                                   file.path, each.line, each.result.id, list.path));
    }
    if (foreign <= kMostNamed) continue;
    faults.push_back(fmt::format("{}: and {} of another list", file.path,
                                 Counted(foreign - kMostNamed, "more result")));
  }
  return faults;
}

std::string DefaultResultsOf(const std::string& list, const Shard& shard) {
  const std::string stem = StemOf(list);
  if (shard.count == 1) return stem + ".results.jsonl";
  return fmt::format("{}.results.{}-of-{}.jsonl", stem, shard.number, shard.count);
}

std::vector<std::string> FindResultsOf(const std::string& list) {
  const std::string stem = options::PatternOfName(StemOf(list));
  std::vector<std::string> found = options::FilesMatching(stem + ".results.jsonl");
  for (std::string& file : options::FilesMatching(stem + ".results.*-of-*.jsonl")) {
    found.push_back(std::move(file));
  }
  return found;
}

}  // namespace kinescope::app
