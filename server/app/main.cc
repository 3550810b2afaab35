#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>

#include "core/errors.h"
#include "core/stop_signal.h"
#include "server/app/commands.h"
#include "server/ros/bridge.h"
#include "server/source/open_source.h"

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

// CLI11 would only say that a subcommand is required.
void RefuseUnknownCommand(const CLI::App& line, const std::string& word) {
  if (word.empty() || word[0] == '-') return;
  std::string known;
  for (const CLI::App* command : line.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
    known += " " + command->get_name();
  }
  throw kinescope::UsageError("'" + word + "' is no command; there are" + known + " (see --help)");
}

}  // namespace

int main(int argc, char** argv) {
  using namespace kinescope;
  int exit_code = 0;
  try {
    SetUpLog();
    app::CatchStopSignals();
    std::signal(SIGXFSZ, SIG_IGN);  // a limit on file size is then an error like a full disk
    // Takes `a:=b` and `__name:=` out of argv.
    ros_bridge::InitRos(argc, argv, NodeName(argc, argv));

    CLI::App line(
        "Kinescope: watch a motion-captured human without a screen.\n"
        "Source: " +
        std::string(app::kSourceKinds) + ".");
    line.name("kinescope");
    line.require_subcommand(1);
    line.set_version_flag("--version", KINESCOPE_VERSION);
    line.failure_message([](const CLI::App*, const CLI::Error& error) {
      return std::string("kinescope: ") + error.what() + " (see --help)\n";
    });
    const app::CommandLine commands{line, exit_code};
    app::AddServe(commands);
    app::AddBridge(commands);
    app::AddRender(commands);
    app::AddLoads(commands);
    app::AddGolden(commands);
    app::AddStream(commands);
    app::AddRecord(commands);
    app::AddInspect(commands);
    app::AddUrdf(commands);
    app::AddProbe(commands);
    RefuseUnknownCommand(line, argc > 1 ? argv[1] : "");
    try {
      line.parse(argc, argv);
      FlushStdout();
    } catch (const CLI::ParseError& error) {
      return line.exit(error) == 0 ? 0 : 2;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "kinescope: %s\n", error.what());
    return 2;
  }
  return exit_code;
}
