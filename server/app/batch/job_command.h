/// From a job to the command that does it. One thread.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "server/app/batch/job.h"
#include "server/app/command.h"

namespace kinescope::app {

class DrawPools;

/// The words that may stand in "command".
std::vector<std::string> CommandsOfJobs();

/// A command of that name, its options as they are by default. `pools` outlive it.
/// @pre `name` is one of CommandsOfJobs()
Command CommandNamed(const std::string& name, const std::shared_ptr<DrawPools>& pools);

/// The command of `job` with its options set and checked. Options that say how it is executed are
/// those of one of several jobs beside each other, unless the job has them: one picture at a time.
/// @throws UsageError.
Command CommandOf(const Job& job, const std::shared_ptr<DrawPools>& pools);

/// What it writes. @throws UsageError, also for what would go to standard output.
std::vector<DeclaredOutput> OutputsOf(const Command& command);

/// The paths of files and folders that it reads and that are there.
std::vector<std::string> InputsOf(const Command& command);

}  // namespace kinescope::app
