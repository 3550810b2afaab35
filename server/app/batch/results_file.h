/// The results of a batch: JSON Lines, one for each job that has ended. A process that writes one
/// has it alone, as long as the object lives. One thread at a time.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/app/batch/job_result.h"

namespace kinescope::app {

/// A line of results.
struct FoundResult {
  int line = 0;      // from 1
  std::string text;  // of the line, without its end
  JobResult result;
};

struct FoundResults {
  std::string path;
  std::vector<FoundResult> results;
  std::vector<std::string> faults;  // "r.jsonl:3: not a result: …"
  std::vector<std::string> faulty_lines;
  bool has_unfinished_line = false;  // the last one, which a process was killed writing
};

/// None if the file is not there. @throws SourceError.
FoundResults ReadResults(const std::string& path);

class ResultsFile {
 public:
  /// @throws UsageError if another process writes it; std::runtime_error if it cannot be opened.
  explicit ResultsFile(std::string path);
  ~ResultsFile();
  ResultsFile(const ResultsFile&) = delete;
  ResultsFile& operator=(const ResultsFile&) = delete;

  /// Keeps only these of the lines that are there. @throws std::runtime_error; they are then as
  /// before.
  void KeepOnly(const std::vector<std::string>& lines);

  /// Writes the line of a job. What a full disk refuses is written with the next one.
  void Add(const JobResult& result);

  /// @throws std::runtime_error with the reason, if lines could not be written.
  void Finish();

 private:
  void Open();
  void Close();
  /// Writes all of it or none. @return whether it is written
  bool Write(int file, std::string_view text);

  const std::string path_;
  int file_ = -1;
  std::string waiting_;  // lines that could not be written yet
  int waiting_lines_ = 0;
  std::string problem_;  // why
};

}  // namespace kinescope::app
