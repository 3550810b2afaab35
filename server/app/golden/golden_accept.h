/// Takes pictures of a run without drawing them again, on any machine: all that `golden accept`
/// names, or one for `golden review`. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "server/app/golden/golden_run.h"
#include "server/app/golden/golden_suite.h"

namespace kinescope::app {

struct AcceptSettings {
  std::filesystem::path run;       // folder that a check has left
  std::vector<std::string> names;  // cases; none: all of the run that are not the same
  std::string folder;              // of the cases; "": the one of the run
  bool takes_other_environment = false;
};

/// Of the cases that pictures of `run` are accepted for.
std::filesystem::path FolderFor(const GoldenRun& run, const AcceptSettings& settings);

/// Those cases, as they are now. @throws as FindGoldenSuite().
GoldenSuite SuiteFor(const GoldenRun& run, const AcceptSettings& settings);

/// Makes what the run has drawn of one case the accepted picture, and its entry of `suite.lock`,
/// which the caller writes. It is taken if case, inputs and accepted picture are those of the run,
/// if the file is the one that was drawn, and if its environment is that of the other accepted
/// pictures.
/// @throws std::exception why it is not taken; then nothing is changed.
void TakeCase(const CaseVerdict& drawn, const AcceptSettings& settings, GoldenSuite& suite);

/// Takes all cases that `settings` name and prints a line for each. Returns the exit code: 0, or 2
/// if one was not taken.
/// @throws UsageError if there is no such run or case; std::runtime_error if `golden.lock` cannot
/// be written.
int AcceptRun(const AcceptSettings& settings);

}  // namespace kinescope::app
