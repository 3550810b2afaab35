// `kinescope serve` and `kinescope bridge`: a source, live, to ROS, pictures and page.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/system/clocks.h"
#include "core/system/errors.h"
#include "core/system/words.h"
#include "server/app/commands.h"
#include "server/app/log.h"
#include "server/app/serve/page_token.h"
#include "server/app/serve/serve_config.h"
#include "server/app/serve/serve_options.h"
#include "server/app/serve/server.h"
#include "server/options/option_list.h"
#include "server/ros/bridge.h"
#include "server/source/paced_source.h"

namespace kinescope::app {
namespace {

// @throws UsageError if an option cannot have such a value
options::Found ValueOf(const ros_bridge::NodeParameter& parameter, const options::Option& option) {
  using Kind = ros_bridge::NodeParameter::Kind;
  options::Found found{"", "~"};
  switch (parameter.kind) {
    case Kind::kText: found.text = parameter.texts.front(); return found;
    case Kind::kSwitch: {
      const std::string word = parameter.texts.front() == "true" ? "on" : "off";
      const std::vector<std::string> words = option.value->Names();
      const bool is_word = std::find(words.begin(), words.end(), word) != words.end();
      found.text = is_word ? word : parameter.texts.front();
      return found;
    }
    case Kind::kList:
      if (option.value->is_repeatable() && !parameter.texts.empty()) {
        found.texts = parameter.texts;
        return found;
      }
      throw UsageError("~" + option.name + ": is a list; expected one value");
    case Kind::kOther: break;
  }
  throw UsageError("~" + option.name + ": is a map of names and values; expected one value");
}

// This node writes it (server/ros/description_parameters.h), and it stays when the node has ended.
constexpr char kOwnParameter[] = "human_description";

// Private parameters of this node: ~name.
void ReadParameters(const ServeOptions& options, const std::string& command,
                    options::OptionList& list) {
  if (*options.ros == ros_bridge::RosMode::kOff || !ros_bridge::BuiltWithRos()) return;
  const auto& parameters = ros_bridge::PrivateParameters();
  for (const auto& [name, parameter] : parameters) {
    const bool may_be_namespace = parameter.kind == ros_bridge::NodeParameter::Kind::kOther;
    if (may_be_namespace || list.Find(name) != nullptr || name == kOwnParameter) continue;
    spdlog::warn("~{}: kinescope {} has no such parameter; it is not used{}", name, command,
                 SuggestionFor(name, list.Names()));
  }
  options::SetFrom(
      [&](const std::string& name) -> std::optional<options::Found> {
        const auto parameter = parameters.find(name);
        const options::Option* const option = list.Find(name);
        if (parameter == parameters.end() || option == nullptr) return std::nullopt;
        return ValueOf(parameter->second, *option);
      },
      options::Channel::kParameter, list);
}

Command Make(const char* name, bool with_page) {
  const auto values = std::make_shared<ServeOptions>();
  Command command = CommandNamed(name);
  if (with_page) {
    values->List(command.options);
  } else {
    values->ListBridge(command.options);
  }
  command.positionals = {"source"};
  command.footer =
      "Every option is also a private ROS parameter: ~name. Order of precedence: command "
      "line, ROS parameter, --config file.";
  command.run = [values, with_page, name = command.name](options::OptionList& list) {
    ReadParameters(*values, name, list);
    for (const char* which : {"token", "token_file", "viewer_token", "viewer_token_file"}) {
      const options::Option* option = list.Find(which);
      if (option != nullptr) CheckTokenIsGiven(option->given_as, option->value->ToText());
    }
    if (const options::Option* token = list.Find("token")) values->token_given_as = token->given_as;
    if (const options::Option* token = list.Find("viewer_token")) {
      values->viewer_token_given_as = token->given_as;
    }
    if (with_page) ApplyRviz(values->rviz, values->picture_size->height, list);
    ServeConfig config = MakeServeConfig(*values, with_page);
    // A terminal is read by the person who opens the page; anything else may be a log that stays.
    config.shows_token = ::isatty(STDERR_FILENO) == 1;
    if (config.ros) {  // before there are other threads, which log
      config.log = std::make_shared<LogTail>();
      spdlog::default_logger()->sinks().push_back(config.log);
    }
    // The moment at which it stands still is now.
    if (config.stop_at) SetMonotonicClock(kStoppedOriginNanos + *config.stop_at);
    Server(config).Run();
    return 0;
  };
  return command;
}

}  // namespace

Command ServeCommand() { return Make("serve", true); }

Command BridgeCommand() { return Make("bridge", false); }

}  // namespace kinescope::app
