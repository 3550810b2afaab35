#include "server/app/commands.h"

namespace kinescope::app {

std::vector<Command> AllCommands() {
  std::vector<Command> commands;
  for (const auto make :
       {ServeCommand, BridgeCommand, RenderCommand, LoadsCommand, ConvertCommand, GoldenCommand,
        BatchCommand, JobsCommand, StudyCommand, StreamCommand, RecordCommand, InspectCommand,
        StripCommand, UrdfCommand, RvizCommand, ProbeCommand}) {
    commands.push_back(make());
  }
  return commands;
}

}  // namespace kinescope::app
