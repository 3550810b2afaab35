/// How a job ended: one line of results. Values; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "server/app/batch/file_stamp.h"
#include "server/app/batch/job.h"

namespace kinescope::app {

enum class JobState {
  kDone,
  kKept,  // what it makes was there already and is what it would have made
  kFailed,
  kInterrupted,
};

/// "done", "kept", "failed", "interrupted".
const char* NameOf(JobState state);

struct JobOutput {
  std::string option;  // that names it
  FileStamp stamp;
  std::string sha256;  // as HashOf()
  DeclaredOutput::Kind kind = DeclaredOutput::Kind::kFile;
};

struct JobResult {
  std::string id, command;
  std::map<std::string, std::string> labels;
  std::string digest;  // Job::Digest()
  JobState state = JobState::kInterrupted;
  std::string reason;                  // why it failed or was interrupted
  double secs = 0, cpu_secs = 0;       // of the job, without the start of its process
  std::int64_t peak_memory_bytes = 0;  // resident, of its process
  std::int64_t started_millis = 0;     // since 1970
  std::string host;                    // that did it
  int attempts = 1;                    // this one and those before it
  std::vector<FileStamp> inputs;       // of those that are files or folders
  std::vector<JobOutput> outputs;
  std::vector<std::string> warnings;  // what it logged

  bool is_complete() const { return state == JobState::kDone || state == JobState::kKept; }
};

/// One of `job` that begins now.
JobResult ResultFor(const Job& job);

/// Bytes of a line of results.
inline constexpr std::size_t kMostResultBytes = 4 << 20;

/// One line of JSON, without the line break.
std::string ToLine(const JobResult& result);

/// @throws std::runtime_error if `line` is none that ToLine() writes.
JobResult ReadResult(std::string_view line);

/// Why it does not show what `job` would make now: "" if it does. Reads the file system; a file
/// whose time has changed is hashed.
std::string WhyStale(const JobResult& result, const Job& job);

}  // namespace kinescope::app
