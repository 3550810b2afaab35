/// What results say of the jobs of a list: which are complete, which are to be done. Reads files;
/// one thread.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "server/app/batch/job_list.h"
#include "server/app/batch/results_file.h"
#include "server/app/shard.h"

namespace kinescope::app {

enum class Standing {
  kComplete,
  kMissing,  // there is no result of it
  kInterrupted,
  kFailed,
  kStale,  // its result is not what it would make now
};

struct JobStanding {
  const Job* job = nullptr;
  Standing standing = Standing::kMissing;
  std::string why;                     // "clips/s01.mp4 is missing"
  const FoundResult* found = nullptr;  // its newest result; null: none
};

/// Of the jobs of a share of `list`, in its order. The newest result of a job counts. All are
/// borrowed.
std::vector<JobStanding> StandingsOf(const JobList& list, const Shard& shard,
                                     const std::vector<FoundResults>& results);

/// What is wrong with results: lines that are none, and those of jobs that are not in the list.
std::vector<std::string> FaultsOf(const std::vector<FoundResults>& results, const JobList& list);

/// "jobs.results.jsonl" of "jobs.jsonl", "jobs.results.3-of-16.jsonl" of a share of it.
std::string DefaultResultsOf(const std::string& list, const Shard& shard);

/// The results of a list under their default names, of all shares.
std::vector<std::string> FindResultsOf(const std::string& list);

}  // namespace kinescope::app
