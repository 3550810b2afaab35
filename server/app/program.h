/// What the programs of commands have in common.
#pragma once

#include <vector>

#include "server/app/command.h"

namespace kinescope::app {

/// Sets up the process, and runs its command line. Called by main. @return the exit code.
int RunProgram(int argc, char** argv, std::vector<Command> (*commands)());

}  // namespace kinescope::app
