/// All commands: one line about each, and the program that has it. The program that people start
/// links this instead of the commands.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/system/install_paths.h"

namespace kinescope::app {

struct CommandEntry {
  const char* name;
  const char* summary;  // its line in --help
  const char* program;  // kMainProgram: what `./demo` shows needs it
};

/// In the order of --help.
constexpr CommandEntry kCommands[] = {
    {"serve", "Shows a source live: ROS topics, pictures and a web page", kMainProgram},
    {"bridge", "Publishes a source to ROS; draws nothing", kMainProgram},
    {"render", "Renders recordings to pictures and clips.", kMainProgram},
    {"loads", "Computes the joint loads of a recording: table, CSV, JSON, plots, report.",
     kToolsProgram},
    {"convert",
     "Converts a motion from any source into files for other programs: CSV tables and MVNX 4.",
     kToolsProgram},
    {"golden", "Compares pictures with the accepted ones", kToolsProgram},
    {"batch", "Does the jobs of a list: render, loads, convert and golden, on one machine or many.",
     kToolsProgram},
    {"jobs",
     "Writes the list of jobs for kinescope batch to standard output: one job per recording.",
     kToolsProgram},
    {"study",
     "Says what the trials of a study have in common: loads by person, condition and joint, what "
     "failed and why.",
     kToolsProgram},
    {"stream", "Sends a source as a suit would, over UDP or TCP, with faults on request",
     kMainProgram},
    {"record", "Records the stream as a capture (pcap) that Kinescope plays and Wireshark opens.",
     kToolsProgram},
    {"inspect", "Lists the contents of a stream or a file: people, messages, rates, losses, errors",
     kToolsProgram},
    {"strip", "Reads the frame code out of clips and pictures: the sample that each frame shows.",
     kToolsProgram},
    {"urdf",
     "Writes the URDF of a person; `urdf check FILE` checks a URDF, `urdf picture FILE` draws one",
     kToolsProgram},
    {"rviz", "Writes an RViz configuration for the nodes that run, and starts RViz with it",
     kToolsProgram},
    {"probe", "Reports the rendering back-ends, encoders and ROS master of this machine",
     kMainProgram},
};

/// nullptr: there is none of that name.
const CommandEntry* FindCommand(const std::string& name);

std::vector<std::string> CommandNames();

/// The program that has the command; for a name that no command has, the main one.
/// @throws std::runtime_error if it is not there, with what to do.
std::filesystem::path ProgramOf(const std::string& command);

}  // namespace kinescope::app
