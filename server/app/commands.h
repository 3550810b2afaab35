/// The subcommands.
#pragma once

#include <vector>

#include "server/app/command.h"

namespace kinescope::app {

Command ServeCommand();    // source -> ROS, pictures, page
Command BridgeCommand();   // source -> ROS only
Command RenderCommand();   // source -> PNG or clips
Command LoadsCommand();    // source -> CSV, JSON, plots, report
Command ConvertCommand();  // source -> motion files
Command GoldenCommand();   // check, accept, ... golden images
Command StreamCommand();   // source -> MVN network stream
Command RecordCommand();   // source -> capture file
Command InspectCommand();  // contents of a source
Command StripCommand();    // clip or picture -> which samples it shows
Command UrdfCommand();     // the person's URDF; check or draw any
Command RvizCommand();     // RViz configuration of running nodes
Command ProbeCommand();    // capabilities of this machine

/// In the order of --help.
std::vector<Command> AllCommands();

}  // namespace kinescope::app
