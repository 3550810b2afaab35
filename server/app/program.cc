#include "server/app/program.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>

#include "core/system/standard_streams.h"
#include "core/system/stop_signal.h"
#include "core/system/utf8.h"
#include "server/app/log.h"
#include "server/ros/bridge.h"

namespace kinescope::app {
namespace {

// stdout belongs to results (--json, paths); what is said to people goes to stderr.
void SetUpLog() {
  auto log = spdlog::stderr_color_mt("kinescope");
  MakeLinesPrintable(*log);
  spdlog::set_default_logger(log);
}

// A node ends another one of its name. A look at a graph must not end the Kinescope that publishes
// to it.
std::string NodeName(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  return command == "inspect" || command == "urdf" ? "kinescope_" + command : "kinescope";
}

}  // namespace

int RunProgram(int argc, char** argv, std::vector<Command> (*commands)()) {
  try {
    OpenStandardStreams();
    SetUpLog();
    CatchStopSignals();
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on file size is then an error like a full disk
    std::signal(SIGPIPE, SIG_IGN);  // a log without a reader (2>&1 | head) ends nothing
    ros_bridge::TakeRosArguments(argc, argv, NodeName(argc, argv));

    const int exit_code = RunCommandLine(argc, argv, commands());
    FlushStandardOutput();
    return exit_code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinescope: %s\n", PrintableLine(error.what()).c_str());
    return 2;
  }
}

}  // namespace kinescope::app
