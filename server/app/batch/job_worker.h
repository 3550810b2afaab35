/// The process that does jobs, one after the other, on one core: what is made for a picture, such
/// as the renderer, is kept for the next one. It lives beside the process that hands them out
/// (batch_run.h), so that a job that crashes fails alone. One thread.
#pragma once

#include <string>
#include <vector>

namespace kinescope::app {

/// The channel of ProcessGroup.
inline constexpr int kOrdersFrom = 3, kResultsTo = 4;

/// Does the jobs that come from kOrdersFrom, a line each as in a list, and writes a line of results
/// for each to kResultsTo, until there are no more. @return the exit code.
int WorkOff();

}  // namespace kinescope::app
