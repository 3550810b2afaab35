/// `golden stress`: draws cases again and again under other circumstances, none of which may change
/// a byte. One thread.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kinescope::app {

struct StressSettings {
  std::filesystem::path folder;    // of the cases
  std::vector<std::string> names;  // none: all
  std::string backend;
  int rounds = 1;  // of all circumstances
};

/// Prints a line for each circumstance: number of threads, locale, time zone, working folder,
/// read-only home, low priority. Returns the exit code: 0 all bytes were the same, 1 a picture
/// differed, 2 a case could not be drawn.
/// @throws std::runtime_error if it cannot start itself, or when interrupted.
int StressSuite(const StressSettings& settings);

}  // namespace kinescope::app
