/// A job of `kinescope batch`: one line of a list. Values; any thread.
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace kinescope::app {

struct Job {
  std::string id;                                     // its name in lists, results and messages
  std::string command;                                // one of CommandsOfJobs()
  nlohmann::json options = nlohmann::json::object();  // by name
  std::map<std::string, std::string> labels;          // what a study groups by: person, condition
  int line = 0;                                       // in its list, from 1

  /// SHA-256 of what decides its result: command and options, but not their order.
  std::string Digest() const;
};

/// Bytes of a line.
inline constexpr std::size_t kMostJobBytes = 1 << 20;

/// Reads one line. @throws UsageError with the reason, without the place.
Job ReadJob(std::string_view text);

/// As ReadJob() reads it, without the line break.
std::string ToLine(const Job& job);

}  // namespace kinescope::app
