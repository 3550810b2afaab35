/// The folder that a check leaves: new pictures, and `run.json` with the verdicts, hashes of inputs
/// and environment, from which pictures are accepted on another machine. A run may come from a
/// stranger: what is read is what a check can have written, and no more. Pure but for files; one
/// thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/golden_verdict.h"

namespace kinescope::app {

/// Removes what an earlier run of this name has left: its pictures and its `run.json`. Other files
/// stay. @throws std::runtime_error if they cannot be removed.
void ClearRun(const std::filesystem::path& out);

/// `folder`: of the cases. @throws std::runtime_error if it cannot be written.
void WriteRun(const std::filesystem::path& out, const std::filesystem::path& folder,
              const std::vector<CaseVerdict>& verdicts);

struct GoldenRun {
  std::filesystem::path folder;  // of the cases, as the run was given it
  std::string version;           // of the program that has drawn
  /// The names of those that were drawn are names of files without a
  /// folder, and each is there once.
  std::vector<CaseVerdict> verdicts;
};

/// The content of `run.json`. @throws std::exception with the reason.
GoldenRun ParseRun(const std::string& text);

/// @throws UsageError with the file and the reason if there is no run, or it cannot be read.
GoldenRun ReadRun(const std::filesystem::path& out);

}  // namespace kinescope::app
