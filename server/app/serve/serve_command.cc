// `kinescope serve` and `kinescope bridge`: a source, live, to ROS, pictures and page.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <memory>
#include <optional>
#include <string>

#include "core/system/clocks.h"
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

// Private parameters of this node: ~name.
void ReadParameters(const ServeOptions& options, options::OptionList& list) {
  if (*options.ros == ros_bridge::RosMode::kOff || !ros_bridge::BuiltWithRos()) return;
  options::SetFrom(
      [](const std::string& name) -> std::optional<options::Found> {
        const auto text = ros_bridge::PrivateParameter(name);
        if (!text) return std::nullopt;
        return options::Found{*text, "~"};
      },
      options::Channel::kParameter, list);
}

Command Make(const char* name, const char* about, bool with_page) {
  const auto values = std::make_shared<ServeOptions>();
  Command command;
  command.name = name;
  command.about = about;
  if (with_page) {
    values->List(command.options);
  } else {
    values->ListBridge(command.options);
  }
  command.positionals = {"source"};
  command.footer =
      "Every option is also a private ROS parameter: ~name. Order of precedence: command "
      "line, ROS parameter, --config file.";
  command.run = [values, with_page](options::OptionList& list) {
    ReadParameters(*values, list);
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

Command ServeCommand() {
  return Make("serve", "Shows a source live: ROS topics, pictures and a web page", true);
}

Command BridgeCommand() {
  return Make("bridge", "Publishes a source to ROS; draws nothing", false);
}

}  // namespace kinescope::app
