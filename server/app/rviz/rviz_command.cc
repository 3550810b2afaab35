// `kinescope rviz`: a configuration of RViz for the nodes that run.
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "core/system/errors.h"
#include "core/system/install_paths.h"
#include "server/app/commands.h"
#include "server/app/print.h"
#include "server/app/rviz/rviz_config.h"
#include "server/options/option_list.h"
#include "server/ros/bridge.h"
#include "server/ros/running.h"
#include "server/table/output_file.h"

namespace kinescope::app {
namespace {

struct RvizOptions {
  options::Text out, node;

  void List(options::OptionList& option) {
    option("out", out, "RViz configuration to write, .rviz; -: standard output");
    option("node", node, "name of the node, as /kinescope; needed where several run");
  }
};

ros_bridge::RunningNode Choose(const std::string& name) {
  const std::vector<ros_bridge::RunningNode> nodes = ros_bridge::FindRunningNodes();
  std::vector<std::string> names;
  for (const ros_bridge::RunningNode& node : nodes) {
    if (node.name == name || (name.empty() && nodes.size() == 1)) return node;
    names.push_back(node.name);
  }
  const std::string where = ros_bridge::MasterUri();
  if (nodes.empty()) {
    throw UsageError(fmt::format(
        "no Kinescope node runs at the ROS master {}; start one (kinescope serve, kinescope "
        "bridge), or set ROS_MASTER_URI",
        where));
  }
  if (name.empty()) {
    throw UsageError(fmt::format("several nodes run at {}: choose one with --node: {}", where,
                                 fmt::join(names, ", ")));
  }
  throw UsageError(fmt::format("--node={}: no such node at {}; there are: {}", name, where,
                               fmt::join(names, ", ")));
}

std::string UsualConfig() {
  const auto path = FindResource("launch/kinescope.rviz");
  std::ifstream file(path);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (text.empty()) {
    throw UsageError(
        "launch/kinescope.rviz was not found beside the program; install Kinescope "
        "completely");
  }
  return text;
}

}  // namespace

Command RvizCommand() {
  const auto values = std::make_shared<RvizOptions>();
  Command command;
  command.name = "rviz";
  command.about = "Writes an RViz configuration for the nodes that run";
  values->List(command.options);
  command.required = {"out"};
  command.footer = "Show it: rviz -d FILE";
  command.run = [values](options::OptionList&) {
    const ros_bridge::RunningNode node = Choose(*values->node);
    OutputFile out(*values->out);
    out.buffer() = RvizConfig(UsualConfig(), node);
    out.Finish();
    if (*values->out == "-") return 0;
    Print("{}: {} {} of {}; rviz -d {}\n", *values->out, node.people.size(),
          node.people.size() == 1 ? "person" : "people", node.name, *values->out);
    return 0;
  };
  return command;
}

}  // namespace kinescope::app
