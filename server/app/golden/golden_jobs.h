/// Compares golden cases in processes of their own, several at a time: a case that crashes or hangs
/// its process fails alone. One thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/app/golden/golden_check.h"
#include "server/app/golden/golden_suite.h"
#include "server/picture/backend.h"

namespace kinescope::app {

struct JobSettings {
  int jobs = 1;                      // processes at a time
  double limit_secs = 120;           // for one case
  std::vector<std::string> command;  // of a process; it calls AnswerOrders()
};

/// Of `golden check` as such a process.
std::vector<std::string> CommandOfJobs(const std::string& folder, const CheckSettings& settings,
                                       const BackendOptions& backend);

/// Calls `report` with every verdict, in the order of the suite, what belongs to no case last.
/// @throws std::runtime_error when interrupted, or with the reason if no process can draw.
void CheckInProcesses(const GoldenSuite& suite, const JobSettings& settings,
                      const std::function<void(const CaseVerdict&)>& report);

/// In such a process: compares the cases whose names come from standard input, each ended by a zero
/// byte, and prints a line of JSON for each, or for the reason why it cannot go on. Returns when
/// the input ends.
void AnswerOrders(const GoldenSuite& suite, const CheckSettings& settings,
                  const BackendOptions& backend);

}  // namespace kinescope::app
