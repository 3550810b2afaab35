#include "server/app/commands.h"

namespace kinescope::app {

std::vector<Command> ToolCommands() {
  std::vector<Command> commands;
  for (const auto make :
       {LoadsCommand, ConvertCommand, GoldenCommand, BatchCommand, JobsCommand, StudyCommand,
        RecordCommand, InspectCommand, StripCommand, UrdfCommand, RvizCommand}) {
    commands.push_back(make());
  }
  return commands;
}

}  // namespace kinescope::app
