/// The subcommands. Each adds itself to the command line and, when chosen, runs and sets the exit
/// code: 0 good, 1 the answer is no, 2 could not (by throwing; main prints the one line).
#pragma once

#include <CLI/CLI.hpp>

namespace kinescope::app {

struct CommandLine {
  CLI::App& app;
  int& exit_code;
};

void AddServe(CommandLine line);    // source -> ROS, pictures, page
void AddBridge(CommandLine line);   // source -> ROS only
void AddRender(CommandLine line);   // source -> PNG or MP4
void AddLoads(CommandLine line);    // source -> CSV, JSON, plots, report
void AddGolden(CommandLine line);   // check | update golden images
void AddStream(CommandLine line);   // source -> MVN network stream
void AddRecord(CommandLine line);   // source -> capture file
void AddInspect(CommandLine line);  // what is in a source
void AddUrdf(CommandLine line);     // the person's URDF; check one
void AddProbe(CommandLine line);    // what this machine has

}  // namespace kinescope::app
