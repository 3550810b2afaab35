/// A subcommand: its options and what it runs. commands.cc lists them; command_line.cc shows them
/// to users.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "server/options/option_list.h"

namespace kinescope::app {

struct Command {
  std::string name;
  std::string about;   // what it does, and examples
  std::string footer;  // after the options in --help
  options::OptionList options;
  /// Options that may be given without their --name, in this order; a repeatable one takes the
  /// rest.
  std::vector<std::string> positionals;
  std::set<std::string> required;
  /// Called with the options set. Returns the exit code: 0 success, 1 the check failed or nothing
  /// was found. @throws std::exception, whose text is shown; the exit code is then 2.
  std::function<int(options::OptionList& options)> run;
  std::vector<Command> parts;  // subcommands of its own
};

/// Reads the command line, then the file of --config, for options that the command line left open,
/// and runs the command. @return the exit code. @throws UsageError naming what was wrong.
int RunCommandLine(int argc, char** argv, std::vector<Command> commands);

}  // namespace kinescope::app
