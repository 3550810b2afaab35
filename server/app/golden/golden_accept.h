/// `golden accept`: takes pictures of a run without drawing them again, on any machine. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinescope::app {

struct AcceptSettings {
  std::filesystem::path run;       // folder that a check has left
  std::vector<std::string> names;  // cases; none: all of the run that are not the same
  std::string folder;              // of the cases; "": the one of the run
  bool takes_other_environment = false;
};

/// Prints a line for each case. A picture is taken if case, inputs and accepted picture are those
/// of the run, and if the environment is that of the other accepted pictures. Returns the exit
/// code: 0, or 2 if one was not taken.
/// @throws UsageError if there is no such run or case, or in CI; std::runtime_error if a file
/// cannot be written.
int AcceptRun(const AcceptSettings& settings);

}  // namespace kinescope::app
