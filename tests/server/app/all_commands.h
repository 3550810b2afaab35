/// The commands of both programs.
#pragma once

#include <iterator>
#include <vector>

#include "server/app/commands.h"

namespace kinescope::testing {

inline std::vector<app::Command> AllCommands() {
  std::vector<app::Command> commands = app::MainCommands(), tools = app::ToolCommands();
  commands.insert(commands.end(), std::move_iterator(tools.begin()),
                  std::move_iterator(tools.end()));
  return commands;
}

}  // namespace kinescope::testing
