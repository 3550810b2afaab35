/// A subcommand: its options and what it runs. command_table.cc lists them; command_line.cc shows
/// them to users.
#pragma once

#include <functional>
#include <set>
#include <string>
#include <vector>

#include "server/options/option_list.h"

namespace kinescope::app {

/// A file that a command writes.
struct DeclaredOutput {
  enum class Kind {
    kFile,
    kNumbered,  // one per picture; `path` has a placeholder for its number
    kFolder,    // what is in it
  };

  std::string option;  // that names it
  std::string path;
  Kind kind = Kind::kFile;
};

struct Command {
  std::string name;
  std::string about;   // what it does, and examples
  std::string footer;  // after the options in --help
  options::OptionList options;
  /// Options that may be given without their --name, in this order; a repeatable one takes the
  /// rest.
  std::vector<std::string> positionals;
  std::set<std::string> required;
  /// Options that name what it reads, besides files that values of options refer to.
  std::vector<std::string> reads;
  /// Called with the options set. Returns the exit code: 0 success, 1 the check failed or nothing
  /// was found. @throws std::exception, whose text is shown; the exit code is then 2.
  std::function<int(options::OptionList& options)> run;
  /// What `run` would write, for callers that must know before. @throws UsageError as `run` would.
  std::function<std::vector<DeclaredOutput>()> outputs;
  std::string failure;          // what exit code 1 means: "no load is known"
  bool shows_progress = false;  // it has the option --progress
  /// Instead of `run`, for a command that also takes options that are not its own: the words of the
  /// command line that it does not know, in their order.
  std::function<int(const std::vector<std::string>& words)> run_with_words;
  std::vector<Command> parts;  // subcommands of its own
};

/// With its name, which is in the table of commands, and what that says about it.
Command CommandNamed(const std::string& name);

/// To be called when all options are set, before the command is run.
/// @throws UsageError: an option that is required is missing, or one has no effect.
void CheckIsComplete(const Command& command);

/// Reads the command line, then the file of --config, for options that the command line left open,
/// and runs the command. --help also lists the commands that other programs have.
/// @return the exit code. @throws UsageError naming what was wrong.
int RunCommandLine(int argc, char** argv, std::vector<Command> commands);

}  // namespace kinescope::app
