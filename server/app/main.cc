#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "core/system/stop_signal.h"
#include "server/app/commands.h"
#include "server/ros/bridge.h"

namespace {

// stdout belongs to results (--json, paths); what is said to people goes to stderr.
void SetUpLog() {
  auto log = spdlog::stderr_color_mt("kinescope");
  log->set_pattern("%H:%M:%S.%e %^%l%$: %v");
  spdlog::set_default_logger(log);
}

// A node ends another one of its name. A look at a graph must not end the Kinescope that publishes
// to it.
std::string NodeName(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  return command == "inspect" || command == "urdf" ? "kinescope_" + command : "kinescope";
}

// What is still in a buffer has to arrive as well; the end of a process would not tell.
void FlushStdout() {
  if (std::fflush(stdout) == 0) return;
  throw std::runtime_error(std::string("cannot write to standard output: ") + std::strerror(errno));
}

}  // namespace

int main(int argc, char** argv) {
  using namespace kinescope;
  try {
    SetUpLog();
    CatchStopSignals();
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on file size is then an error like a full disk
    // Takes `a:=b` and `__name:=` out of argv.
    ros_bridge::InitRos(argc, argv, NodeName(argc, argv));

    const int exit_code = app::RunCommandLine(argc, argv, app::AllCommands());
    FlushStdout();
    return exit_code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinescope: %s\n", error.what());
    return 2;
  }
}
