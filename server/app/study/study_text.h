/// Prints a study as text: what there is, how long each joint was highly loaded in each condition,
/// what failed and why. Pure functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "server/app/study/study.h"

namespace kinescope::app {

/// "24 trials of 4 people in 2 conditions: 21 with loads, 2 failed, 1 interrupted".
std::string HeadlineOf(const Study& study);

/// Several lines.
std::string TextOf(const Study& study);

/// What does the failed jobs again: "kinescope batch jobs.jsonl --retry failed".
std::string RetryCommandOf(const Study& study);

/// "Trials differ in class_limits: 0.3,0.6 (12 trials), 0.4,0.7 (3 trials)"; a line for each
/// option.
std::vector<std::string> DifferencesOf(const Study& study);

}  // namespace kinescope::app
