// `kinescope rviz`: a configuration of RViz for the nodes that run, and RViz with it.
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <vector>

#include "core/system/errors.h"
#include "core/system/install_paths.h"
#include "core/system/state_folder.h"
#include "core/system/stop_signal.h"
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
  options::Flag start, view;

  void List(options::OptionList& option) {
    option("out", out, "RViz configuration to write, .rviz; -: standard output");
    option("node", node,
           "name of the node, as /kinescope, or kinescope in the namespace of this program; needed "
           "where several run");
    option("start", start,
           "start RViz with it, as soon as the node runs; without --out it is kept in "
           "~/.local/state/kinescope");
    option("view", view,
           "with the node's rendered view (~view) behind RViz's own scene, which the node then "
           "renders");
  }
};

// nullopt, with why: it does not run.
std::optional<ros_bridge::RunningNode> Find(const std::string& name, std::string& why) {
  const std::vector<ros_bridge::RunningNode> nodes = ros_bridge::FindRunningNodes();
  std::vector<std::string> names;
  for (const ros_bridge::RunningNode& node : nodes) {
    if (node.name == name || (name.empty() && nodes.size() == 1)) return node;
    names.push_back(node.name);
  }
  const std::string where = ros_bridge::MasterUri();
  if (nodes.empty()) {
    why = fmt::format(
        "no Kinescope node runs at the ROS master {}; start one (kinescope serve, kinescope "
        "bridge), or set ROS_MASTER_URI",
        where);
    return std::nullopt;
  }
  if (name.empty()) {
    throw UsageError(fmt::format("several nodes run at {}: choose one with --node: {}", where,
                                 fmt::join(names, ", ")));
  }
  why = fmt::format("--node={}: no such node at {}; there are: {}", name, where,
                    fmt::join(names, ", "));
  return std::nullopt;
}

// Of launch files: it is started together with the node. nullopt: it was asked to stop.
std::optional<ros_bridge::RunningNode> WaitFor(const std::string& name) {
  constexpr std::chrono::milliseconds kAskEvery(200);
  std::string why;
  for (bool is_first = true; !StopRequested(); is_first = false) {
    if (const auto node = Find(name, why)) return *node;
    if (is_first) spdlog::info("waiting: {}", why);
    std::this_thread::sleep_for(kAskEvery);  // the master sends no notice
  }
  return std::nullopt;
}

// Qt's words for it are about plug-ins.
void CheckDisplay() {
  const auto is_set = [](const char* name) {
    const char* const text = std::getenv(name);
    return text != nullptr && *text != '\0';
  };
  if (is_set("DISPLAY") || is_set("WAYLAND_DISPLAY") || is_set("QT_QPA_PLATFORM")) return;
  throw UsageError(
      "RViz needs a display, and DISPLAY is not set: start it on a computer with one, in a session "
      "of ssh -X, or below xvfb-run; without a display, `kinescope serve` has a page and pictures");
}

ros_bridge::RunningNode Choose(const std::string& name) {
  std::string why;
  if (const auto node = Find(name, why)) return *node;
  throw UsageError(why);
}

// "/lab/kinescope": "lab_kinescope.rviz" in the folder of this program's state.
std::string KeptFile(const ros_bridge::RunningNode& node) {
  const auto folder = StateFolder() / "rviz";
  std::error_code ignored;  // the file cannot be written then, which names it
  std::filesystem::create_directories(folder, ignored);
  std::string name = node.name.substr(1);
  std::replace(name.begin(), name.end(), '/', '_');
  return (folder / (name + ".rviz")).string();
}

// RViz in the place of this process, with its name of the node. @throws UsageError
[[noreturn]] void BecomeRviz(const std::string& file) {
  std::vector<std::string> arguments = {"rviz", "-d", file};
  for (std::string& argument : ros_bridge::TakenRosArguments())
    arguments.push_back(std::move(argument));
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  ::execvp(pointers[0], pointers.data());
  throw UsageError(
      fmt::format("rviz cannot be started ({}); install it (apt install rviz), or show "
                  "{} on another computer",
                  std::generic_category().message(errno), file));
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
  Command command = CommandNamed("rviz");
  values->List(command.options);
  command.footer = "Show a file that was written: rviz -d FILE";
  command.run = [values](options::OptionList&) {
    const bool starts = *values->start;
    if (values->out->empty() && !starts) {
      throw UsageError(
          "expected --out FILE.rviz, to write a configuration, or --start, to show it");
    }
    if (starts && *values->out == "-") throw UsageError("--out=-: --start needs a file");
    if (starts) CheckDisplay();
    const std::string wanted = values->node->empty() ? "" : ros_bridge::FullNodeName(*values->node);
    const auto found = starts ? WaitFor(wanted) : std::optional(Choose(wanted));
    if (!found) return 0;
    const ros_bridge::RunningNode& node = *found;
    const std::string file = values->out->empty() ? KeptFile(node) : *values->out;
    OutputFile out(file);
    out.buffer() = RvizConfig(UsualConfig(), node, *values->view);
    out.Finish();
    if (starts) BecomeRviz(file);
    if (file == "-") return 0;
    Print("{}: {} {} of {}; rviz -d {}\n", file, node.people.size(),
          node.people.size() == 1 ? "person" : "people", node.name, file);
    return 0;
  };
  return command;
}

}  // namespace kinescope::app
