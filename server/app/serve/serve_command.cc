// `kinescope serve` and `kinescope bridge`: a source, live, to ROS, pictures and page.
#include <memory>
#include <optional>
#include <string>

#include "server/app/commands.h"
#include "server/app/serve/serve_config.h"
#include "server/app/serve/serve_options.h"
#include "server/app/serve/server.h"
#include "server/options/option_list.h"
#include "server/ros/bridge.h"

namespace kinescope::app {
namespace {

// Private parameters of this node: ~name.
void ReadParameters(const ServeOptions& options, options::OptionList& list) {
  const bool can_be_there = *options.ros != ros_bridge::RosMode::kOff &&
                            ros_bridge::BuiltWithRos() && ros_bridge::MasterIsReachable();
  if (!can_be_there) return;
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
    Server(MakeServeConfig(*values, with_page)).Run();
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
