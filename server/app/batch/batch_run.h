/// Does jobs in processes of this program, several at a time; each process does one after the
/// other. A job that crashes or hangs its process fails alone.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "server/app/batch/job.h"
#include "server/app/batch/job_result.h"

namespace kinescope::app {

struct BatchSettings {
  int jobs = 1;           // at a time
  double limit_secs = 0;  // for one job; 0: none
};

/// Calls `report` with the result of each of `jobs`, in the order in which they end, on one thread
/// at a time. When the user stops the program, what runs is stopped and what has not begun is
/// reported as interrupted, within 10 s.
void DoJobs(const std::vector<const Job*>& jobs, const BatchSettings& settings,
            const std::function<void(JobResult)>& report);

}  // namespace kinescope::app
