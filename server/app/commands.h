/// The subcommands.
#pragma once

#include <memory>
#include <vector>

#include "server/app/command.h"

namespace kinescope::app {

class DrawPools;

Command ServeCommand();   // source -> ROS, pictures, page
Command BridgeCommand();  // source -> ROS only
Command RenderCommand();  // source -> PNG or clips
/// With pools that outlive the command.
Command RenderCommand(const std::shared_ptr<DrawPools>& pools);
Command LoadsCommand();    // source -> CSV, JSON, plots, report
Command ConvertCommand();  // source -> motion files
Command BatchCommand();    // list of jobs -> what they make
Command JobsCommand();     // recordings -> list of jobs
Command StudyCommand();    // results of jobs -> page, CSV
Command GoldenCommand();   // check, accept, ... golden images
Command StreamCommand();   // source -> MVN network stream
Command RecordCommand();   // source -> capture file
Command InspectCommand();  // contents of a source
Command StripCommand();    // clip or picture -> which samples it shows
Command UrdfCommand();     // the person's URDF; check or draw any
Command RvizCommand();     // RViz configuration of running nodes
Command ProbeCommand();    // capabilities of this machine

/// Those of the main program, and those of the other.
std::vector<Command> MainCommands();
std::vector<Command> ToolCommands();

}  // namespace kinescope::app
