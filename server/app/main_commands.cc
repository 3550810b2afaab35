#include "server/app/commands.h"

namespace kinescope::app {

std::vector<Command> MainCommands() {
  std::vector<Command> commands;
  for (const auto make : {ServeCommand, BridgeCommand, static_cast<Command (*)()>(RenderCommand),
                          StreamCommand, ProbeCommand}) {
    commands.push_back(make());
  }
  return commands;
}

}  // namespace kinescope::app
