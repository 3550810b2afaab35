// The one place that knows CLI11.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/system/errors.h"
#include "core/system/starts_with.h"
#include "core/system/words.h"
#include "server/app/command.h"
#include "server/app/command_table.h"
#include "server/app/print.h"
#include "server/app/progress.h"
#include "server/options/yaml_options.h"

namespace kinescope::app {
namespace {

using options::Channel;
using options::JsonKind;
using options::Option;
using options::OptionList;

// Columns of the terminal that --help uses, and those of names.
constexpr std::size_t kHelpColumns = 100, kNameColumns = 28;

// CLI11 indents what follows a line break, but breaks no lines itself.
std::string Wrapped(const std::string& text) {
  std::istringstream words(text);
  std::string wrapped, word;
  std::size_t column = 0;
  while (words >> word) {
    if (column > 0 && column + 1 + word.size() > kHelpColumns - kNameColumns) {
      wrapped += '\n';
      column = 0;
    } else if (column > 0) {
      wrapped += ' ';
      ++column;
    }
    wrapped += word;
    column += word.size();
  }
  return wrapped;
}

// The expected value stands in brackets, unless the help explains each of its words.
std::string HelpOf(const Option& option) {
  const std::vector<std::string> names = option.value->Names();
  const std::string expected = option.value->Expected();
  const bool explains_all = !names.empty() && expected == Alternatives(names) &&
                            std::all_of(names.begin(), names.end(), [&](const std::string& name) {
                              return option.help.find(name) != std::string::npos;
                            });
  return option.help + (expected.empty() || explains_all ? "" : " [" + expected + "]");
}

// Positionals are options, too, and listed with them.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kNameColumns); }
  std::string make_positionals(const CLI::App* /*app*/) const override { return ""; }
  // The first line of its description; the command's own --help has the rest.
  std::string make_subcommand(const CLI::App* command) const override {
    const std::string about = command->get_description();
    std::ostringstream line;
    CLI::detail::format_help(line, command->get_name(), about.substr(0, about.find('\n')),
                             kNameColumns);
    return line.str();
  }
};

// `name`: of the option, or its former one, which --help does not show.
void AddOption(CLI::App& app, OptionList& list, Option& option, const std::string& name,
               bool is_positional) {
  const std::string names = "--" + name + (is_positional ? "," + name : "");
  CLI::Option* added = nullptr;
  if (option.value->json_kind() == JsonKind::kTruth) {
    added = app.add_flag_function(
        names,
        [&list, &option, name](std::int64_t count) {
          list.Set(option, name, {count > 0 ? "true" : "false"}, Channel::kCommandLine);
        },
        Wrapped(option.help));
  } else if (option.value->is_repeatable()) {
    added = app.add_option_function<std::vector<std::string>>(
                   names,
                   [&list, &option, name](const std::vector<std::string>& texts) {
                     list.Set(option, name, {"", "--", texts}, Channel::kCommandLine);
                   },
                   Wrapped(HelpOf(option)))
                ->allow_extra_args(is_positional);
  } else {
    added = app.add_option_function<std::string>(
        names,
        [&list, &option, name](const std::string& text) {
          list.Set(option, name, {text}, Channel::kCommandLine);
        },
        Wrapped(HelpOf(option)));
    if (option.value->IsGiven()) added->default_str(option.value->ToText());
  }
  added->type_name("");
  const bool is_hidden = option.group == options::kHidden || name != option.name;
  if (is_hidden || !option.group.empty()) added->group(is_hidden ? "" : option.group);
}

// No option of the command's own: what it makes does not depend on it.
void AddProgress(CLI::App& app, ProgressForm& form) {
  app.add_option_function<std::string>(
         "--progress",
         [&form](const std::string& text) {
           options::Choice<ProgressForm> choice{{{"auto", ProgressForm::kAuto},
                                                 {"json", ProgressForm::kJson},
                                                 {"off", ProgressForm::kOff}},
                                                ProgressForm::kAuto};
           options::OptionList list;
           list("progress", choice, "");
           list.Set(*list.begin(), "progress", {text}, Channel::kCommandLine);
           form = *choice;
         },
         Wrapped("progress on standard error: a line on a terminal, or a line of JSON each second "
                 "for programs [auto, json or off]"))
      ->type_name("")
      ->default_str("auto");
}

// A command as CLI11 sees it. The Command stays where it is.
struct Registered {
  Command* command;
  CLI::App* app;
  std::shared_ptr<std::string> config;
  std::shared_ptr<ProgressForm> progress;
};

void Register(Command& command, CLI::App& parent, std::vector<Registered>& all) {
  CLI::App& app = *parent.add_subcommand(command.name, command.about);
  app.formatter(std::make_shared<HelpFormatter>());
  app.footer(command.footer);
  for (Option& option : command.options) {
    const bool is_positional =
        std::count(command.positionals.begin(), command.positionals.end(), option.name) > 0;
    AddOption(app, command.options, option, option.name, is_positional);
    if (!option.former_name.empty()) {
      AddOption(app, command.options, option, option.former_name, false);
    }
  }
  const auto config = std::make_shared<std::string>();
  if (command.run_with_words != nullptr) app.allow_extras();
  if (command.run != nullptr) {
    app.add_option("--config", *config, "YAML file of options, one `name: value` per line")
        ->type_name("");
  }
  const auto progress = std::make_shared<ProgressForm>(ProgressForm::kAuto);
  if (command.shows_progress) AddProgress(app, *progress);
  all.push_back({&command, &app, config, progress});
  if (!command.parts.empty() && command.run == nullptr) app.require_subcommand(1);
  for (Command& part : command.parts) Register(part, app, all);
}

// CLI11 would only say that a subcommand is required.
void RefuseUnknownCommand(const std::vector<Command>& commands, const std::string& word) {
  if (word.empty() || word[0] == '-') return;
  for (const Command& command : commands) {
    if (command.name == word) return;
  }
  if (FindCommand(word) != nullptr) {
    throw UsageError(word + " is a command of another program, which bin/kinescope starts");
  }
  const std::vector<std::string> names = CommandNames();
  throw UsageError(fmt::format("unknown command '{}': expected {}{} (see --help)", word,
                               Alternatives(names), SuggestionFor(word, names)));
}

// In the order of the table. Those of other programs are there to be listed.
void RegisterAll(std::vector<Command>& commands, CLI::App& line, std::vector<Registered>& all) {
  for (const CommandEntry& entry : kCommands) {
    const auto ours = std::find_if(commands.begin(), commands.end(), [&](const Command& command) {
      return command.name == entry.name;
    });
    if (ours != commands.end()) {
      Register(*ours, line, all);
    } else {
      line.add_subcommand(entry.name, entry.summary);
    }
  }
}

// The innermost command that was named.
const Registered* Chosen(const std::vector<Registered>& all) {
  const Registered* chosen = nullptr;
  for (const Registered& each : all) {
    if (each.app->parsed()) chosen = &each;
  }
  return chosen;
}

// Without the value of an option: it may be a token.
[[noreturn]] void RefuseUnknownOption(const Registered& chosen, const std::string& given) {
  const std::string name = given.substr(0, given.find('='));
  std::vector<std::string> names;
  for (const std::string& each : chosen.command->options.Names()) names.push_back("--" + each);
  std::string command = chosen.app->get_name();
  for (const CLI::App* app = chosen.app->get_parent(); app != nullptr; app = app->get_parent()) {
    command = app->get_name() + " " + command;
  }
  const bool is_option = StartsWith(given, "-");
  throw UsageError(fmt::format("unknown {} '{}'{} (see {} --help)",
                               is_option ? "option" : "argument", is_option ? name : given,
                               SuggestionFor(name, names), command));
}

// Names of options have underscores; people also type dashes. "help render" is "render --help".
std::vector<std::string> ArgumentsOf(int argc, char** argv) {
  std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  for (std::string& argument : arguments) {
    if (!StartsWith(argument, "--")) continue;
    const auto end = argument.begin() +
                     static_cast<std::ptrdiff_t>(std::min(argument.find('='), argument.size()));
    std::replace(argument.begin() + 2, end, '-', '_');
  }
  if (!arguments.empty() && arguments.front() == "help") {
    arguments.erase(arguments.begin());
    arguments.emplace_back("--help");
  }
  return arguments;
}

}  // namespace

Command CommandNamed(const std::string& name) {
  const CommandEntry* const entry = FindCommand(name);
  if (entry == nullptr) throw std::logic_error(name + " is not in the table of commands");
  Command command;
  command.name = name;
  command.about = entry->summary;
  return command;
}

void CheckIsComplete(const Command& command) {
  for (const Option& option : command.options) {
    if (option.channel != Channel::kDefault || command.required.count(option.name) == 0) continue;
    throw UsageError(fmt::format("--{} is missing: {}", option.name, HelpOf(option)));
  }
  command.options.CheckEffects();
}

int RunCommandLine(int argc, char** argv, std::vector<Command> commands) {
  CLI::App line(
      "Kinescope: shows and monitors a person in a motion-capture suit, without a display.");
  line.name("kinescope");
  line.formatter(std::make_shared<HelpFormatter>());
  line.require_subcommand(1);
  line.set_version_flag("--version", KINESCOPE_VERSION);
  line.failure_message([](const CLI::App*, const CLI::Error& error) {
    return std::string("kinescope: ") + error.what() + " (see --help)\n";
  });
  std::vector<Registered> all;
  RegisterAll(commands, line, all);
  std::vector<std::string> arguments = ArgumentsOf(argc, argv);
  RefuseUnknownCommand(commands, arguments.empty() ? "" : arguments.front());
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 takes them
  try {
    line.parse(arguments);
  } catch (const CLI::ExtrasError&) {
    const Registered* const chosen = Chosen(all);
    const std::vector<std::string> extras = line.remaining(true);
    if (chosen == nullptr || extras.empty()) throw;
    RefuseUnknownOption(*chosen, extras.front());
  } catch (const CLI::ArgumentMismatch& error) {
    const std::string text = error.what();
    const bool is_repeated = text.find("At Most") != std::string::npos;
    throw UsageError(text.substr(0, text.find(':')) + (is_repeated
                                                           ? ": given several times; give one value"
                                                           : ": value missing (see --help)"));
  } catch (const CLI::RequiredError&) {
    const Registered* const chosen = Chosen(all);
    std::vector<std::string> names;
    if (chosen == nullptr) {
      names = CommandNames();
    } else {
      for (const Command& part : chosen->command->parts) names.push_back(part.name);
    }
    throw UsageError("command missing: expected " + Alternatives(names) + " (see " +
                     (chosen == nullptr ? "kinescope" : "kinescope " + chosen->command->name) +
                     " --help)");
  } catch (const CLI::ParseError& error) {
    // Also --help and --version come here.
    std::ostringstream results, errors;
    const int exit_code = line.exit(error, results, errors);
    PrintText(stdout, results.str());
    PrintText(stderr, errors.str());
    return exit_code == 0 ? 0 : 2;
  }
  const Registered& chosen = *Chosen(all);
  Command& command = *chosen.command;
  if (!chosen.config->empty()) options::YamlOptions(*chosen.config).SetAll(command.options);
  CheckIsComplete(command);
  SetProgressForm(*chosen.progress);
  for (const std::string& warning : command.options.warnings()) spdlog::warn(warning);
  if (command.run_with_words != nullptr) return command.run_with_words(chosen.app->remaining());
  return command.run(command.options);
}

}  // namespace kinescope::app
