// All options of all commands: each rejects a wrong text in one line that has the option, the text
// and what was expected, and reads back what it prints.
#include "server/app/commands.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "core/system/errors.h"
#include "server/app/command_table.h"
#include "server/options/yaml_options.h"
#include "server/picture/backend_probe.h"
#include "tests/server/app/all_commands.h"
#include "tests/temp_folder.h"

namespace kinescope::app {
namespace {

using testing::AllCommands;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

template <class Function>
void ForEveryOption(std::vector<Command>& commands, Function&& function) {
  for (Command& command : commands) {
    for (options::Option& option : command.options) function(command, option);
    ForEveryOption(command.parts, function);
  }
}

std::string ErrorOf(options::OptionList& list, options::Option& option, const std::string& text) {
  try {
    list.Set(option, option.name, {text}, options::Channel::kCommandLine);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Options, RejectInvalidTextsInOneLine) {
  auto commands = AllCommands();
  int rejected = 0;
  ForEveryOption(commands, [&](Command& command, options::Option& option) {
    if (option.value->Expected().empty()) return;  // takes any text
    const std::string bad = "?;=\"wrong/";
    const std::string error = ErrorOf(command.options, option, bad);
    if (option.value->is_repeatable() && error.empty()) return;  // names of files
    EXPECT_THAT(error, AllOf(StartsWith("--" + option.name + "=" + bad + ": "),
                             HasSubstr("expected"), Not(HasSubstr("\n"))))
        << command.name;
    ++rejected;
  });
  EXPECT_GT(rejected, 100);
}

TEST(Options, KeepTheirValueAfterAnInvalidText) {
  auto commands = AllCommands();
  ForEveryOption(commands, [&](Command& command, options::Option& option) {
    const std::string before = option.value->ToText();
    if (ErrorOf(command.options, option, "?;=\"wrong/").empty()) return;
    EXPECT_EQ(option.value->ToText(), before) << command.name << " --" << option.name;
  });
}

TEST(Options, AcceptTheTextOfTheirDefault) {
  auto commands = AllCommands();
  ForEveryOption(commands, [&](Command& command, options::Option& option) {
    if (!option.value->IsGiven()) return;
    const std::string before = option.value->ToText();
    EXPECT_EQ(ErrorOf(command.options, option, before), "") << command.name << " --" << option.name;
    EXPECT_EQ(option.value->ToText(), before) << command.name << " --" << option.name;
  });
}

TEST(Options, HaveUniqueNamesAndACompleteHelpText) {
  auto commands = AllCommands();
  std::set<std::pair<const Command*, std::string>> seen;
  ForEveryOption(commands, [&](Command& command, options::Option& option) {
    EXPECT_TRUE(seen.insert({&command, option.name}).second) << command.name << " " << option.name;
    EXPECT_GT(option.help.size(), 10u) << option.name;
    for (const char* habit : {"of the ", "likewise", "so long", "so many", "the same"}) {
      EXPECT_THAT(option.help, Not(StartsWith(habit))) << option.name;
    }
  });
}

TEST(Commands, AreInTheProgramThatTheTableNames) {
  std::set<std::string> met;
  const auto meet = [&](const std::vector<Command>& commands, const char* program) {
    for (const Command& command : commands) {
      const CommandEntry* const entry = FindCommand(command.name);
      ASSERT_NE(entry, nullptr) << command.name;
      EXPECT_STREQ(entry->program, program) << command.name;
      EXPECT_TRUE(met.insert(command.name).second) << command.name << " is there twice";
    }
  };
  meet(MainCommands(), kMainProgram);
  meet(ToolCommands(), kToolsProgram);
  EXPECT_EQ(met.size(), CommandNames().size());
}

// Commands that show nobody must not fill the user's disk.
TEST(Commands, LoadsAndProbeLeaveTheMeshCacheEmpty) {
  const testing::TempFolder cache, out;
  setenv("XDG_CACHE_HOME", cache.path().c_str(), 1);
  for (Command& command : AllCommands()) {
    if (command.name != "loads") continue;
    for (options::Option& option : command.options) {
      if (option.name == "source") option.value->Parse("demo:lift");
      if (option.name == "seconds") option.value->Parse("0.1");
      if (option.name == "csv") option.value->Parse((out / "loads.csv").string());
    }
    EXPECT_EQ(command.run(command.options), 0);
  }
  EXPECT_EQ(out.Names().size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(cache / "kinescope")) << "after loads";
  EXPECT_TRUE(MeasureBackend("osmesa").works);
  EXPECT_FALSE(std::filesystem::exists(cache / "kinescope")) << "after probe";
  unsetenv("XDG_CACHE_HOME");
}

std::string ErrorOfRunning(const std::string& name, const std::string& yaml_file) {
  for (Command& command : AllCommands()) {
    if (command.name != name) continue;
    options::YamlOptions(yaml_file).SetAll(command.options);
    try {
      command.run(command.options);
    } catch (const UsageError& error) {
      return error.what();
    }
  }
  return "";
}

TEST(Commands, ServeNamesTheLineThatHasABadTokenButNotTheToken) {
  const testing::TempFolder folder;
  const std::string file = (folder / "lab.yaml").string();
  for (const char* token : {"s3cret", "s3cret s3cret s3cret"}) {
    std::ofstream(file) << "ros: off\npictures: off\ntoken: " << token << "\n";
    EXPECT_THAT(ErrorOfRunning("serve", file),
                AllOf(StartsWith(file + ":3: token: "), Not(HasSubstr("s3cret"))));
  }
}

TEST(CommandLine, DoesNotRepeatTheValueOfAnUnknownOption) {
  std::vector<std::string> words = {"kinescope", "serve", "--tokn=s3cret-of-the-lab"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  try {
    RunCommandLine(static_cast<int>(arguments.size()), arguments.data(), AllCommands());
    FAIL() << "unknown option";
  } catch (const UsageError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("unknown option '--tokn'; nearest: --token"),
                                    Not(HasSubstr("s3cret"))));
  }
}

}  // namespace
}  // namespace kinescope::app
