/// `golden update`: accepts what the cases show now. One thread.
#pragma once

#include <filesystem>
#include <string>

#include "server/app/golden/golden_jobs.h"
#include "server/app/golden/golden_suite.h"

namespace kinescope::app {

/// Writes what has changed, and prints a line for each case. What cannot be drawn, or shows
/// nothing, is not accepted and keeps no other case from it. `jobs`: of processes that check the
/// suite and write all pictures into `drawn`. Returns the exit code: 0, or 2 if any was not
/// accepted.
/// @throws std::runtime_error if a file cannot be written, or when interrupted; what was accepted
/// until then stays accepted.
int UpdateSuite(GoldenSuite suite, const JobSettings& jobs, const std::filesystem::path& drawn);

/// From now on, accepted pictures lie in `folder`; moves those that are accepted.
/// @throws std::exception if a file cannot be written.
void MovePictures(GoldenSuite& suite, const std::string& folder);

/// @throws UsageError in CI (environment variable CI), where no person looks at what is accepted.
void RefuseToAcceptInCi();

}  // namespace kinescope::app
