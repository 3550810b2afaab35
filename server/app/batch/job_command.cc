#include "server/app/batch/job_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "core/system/errors.h"
#include "core/system/json_text.h"
#include "core/system/utf8.h"
#include "core/system/words.h"
#include "server/app/commands.h"
#include "server/app/golden/golden_commands.h"

namespace kinescope::app {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using options::Channel;
using options::Found;
using options::Option;

// One of a list, or the only one.
std::string TextOf(const std::string& name, const json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_number() || value.is_boolean()) return JsonText(value);
  throw UsageError(fmt::format("{}: expected a text, a number, true or false", name));
}

Found FoundIn(const Option& option, const json& value) {
  Found found{"", ""};
  if (!value.is_array()) {
    found.text = TextOf(option.name, value);
    // A repeatable option would split it at semicolons, which may be part of a name.
    if (option.value->is_repeatable()) found.texts = {found.text};
    return found;
  }
  for (const json& each : value) found.texts.push_back(TextOf(option.name, each));
  if (found.texts.empty()) throw UsageError(fmt::format("{}: expected a value", option.name));
  if (!option.value->is_repeatable()) {
    const bool is_numbers =
        std::all_of(value.begin(), value.end(), [](const json& each) { return each.is_number(); });
    found.text = fmt::format("{}", fmt::join(found.texts, is_numbers ? "," : ";"));
    found.texts.clear();
  }
  return found;
}

void SetOptions(const Job& job, options::OptionList& list) {
  for (const auto& [name, value] : job.options.items()) {
    Option* const option = list.Find(name);
    if (option == nullptr) {
      throw UsageError(fmt::format("unknown option '{}'{} (see kinescope {} --help)",
                                   PrintableLine(name), SuggestionFor(name, list.Names()),
                                   job.command));
    }
    list.Set(*option, name, FoundIn(*option, value), Channel::kFile);
  }
}

// `jobs` of the command itself.
void UseOneAtATime(options::OptionList& list) {
  Option* const jobs = list.Find("jobs");
  if (jobs != nullptr && jobs->channel == Channel::kDefault) jobs->value->Parse("1");
}

}  // namespace

std::vector<std::string> CommandsOfJobs() { return {"render", "loads", "convert", "golden"}; }

Command CommandNamed(const std::string& name, const std::shared_ptr<DrawPools>& pools) {
  if (name == "render") return RenderCommand(pools);
  if (name == "loads") return LoadsCommand();
  if (name == "convert") return ConvertCommand();
  return GoldenCheckCommand();
}

Command CommandOf(const Job& job, const std::shared_ptr<DrawPools>& pools) {
  Command command = CommandNamed(job.command, pools);
  SetOptions(job, command.options);
  UseOneAtATime(command.options);
  CheckIsComplete(command);
  return command;
}

std::vector<DeclaredOutput> OutputsOf(const Command& command) {
  std::vector<DeclaredOutput> outputs = command.outputs();
  for (const DeclaredOutput& output : outputs) {
    if (output.path != "-") continue;
    throw UsageError(fmt::format("{}=-: standard output belongs to nobody in a batch; name a file",
                                 output.option));
  }
  return outputs;
}

std::vector<std::string> InputsOf(const Command& command) {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const Option& option : command.options) {
    const bool is_read = std::count(command.reads.begin(), command.reads.end(), option.name) > 0;
    std::vector<std::string> named;
    if (is_read) named = option.value->ToTexts();
    for (const fs::path& file : option.value->Files()) named.push_back(file.string());
    for (std::string& path : named) {
      if (!path.empty() && fs::exists(path, ignored)) paths.push_back(std::move(path));
    }
  }
  std::sort(paths.begin(), paths.end());
  paths.erase(std::unique(paths.begin(), paths.end()), paths.end());
  return paths;
}

}  // namespace kinescope::app
