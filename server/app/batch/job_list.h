/// Reads a list of jobs: JSON Lines, one job per line. What is wrong with one job is told with its
/// line and stops no other. Reads files; any thread.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "server/app/batch/job.h"

namespace kinescope::app {

struct JobList {
  std::string path;
  std::vector<Job> jobs;            // each id once
  std::vector<std::string> faults;  // lines that are no job: "jobs.jsonl:3: not valid JSON: …"

  /// "jobs.jsonl:3".
  std::string PlaceOf(const Job& job) const;
};

/// Jobs of a list.
inline constexpr std::size_t kMostJobs = 1'000'000;

/// `path` may be compressed. @throws SourceError, UsageError if it cannot be read or has too many.
JobList ReadJobList(const std::string& path);

/// Why a job is not to be begun: its options are wrong, or an earlier job of the list writes the
/// same file. By the position of the job; "": it may.
std::vector<std::string> RefusalsOf(const JobList& list);

}  // namespace kinescope::app
