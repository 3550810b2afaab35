#include "server/ros/ros_module.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "core/system/errors.h"
#include "core/system/install_paths.h"
#include "core/system/starts_with.h"
#include "core/system/stop_signal.h"
#include "server/ros/awaited_bridge.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/source/graph_source.h"
#include "urdf/robot/urdfdom_lock.h"

namespace kinescope::ros_bridge {
namespace {

#ifdef KINESCOPE_WITH_ROS
constexpr bool kBuiltWithRos = true;
#else
constexpr bool kBuiltWithRos = false;
#endif

constexpr char kFile[] = "libkinescope_ros.so";
constexpr std::chrono::seconds kLookEvery(2);

HostProgram& Program() {
  static HostProgram program = {{"kinescope"}, "kinescope", StopRequested, &urdf::UrdfdomMutex()};
  return program;
}

const RosModule& Load() {
  if (!kBuiltWithRos) {
    throw ModuleError(
        "this Kinescope was built without ROS: install the ROS packages in packages.txt and "
        "configure with -DKINESCOPE_WITH_ROS=ON");
  }
  const auto& module = OpenModule<RosModule>(kFile, kRosEntry);
  module.start(Program());
  return module;
}

// @throws ModuleError, then the next call tries again
const RosModule& Module() {
  static const RosModule& module = Load();
  return module;
}

// @throws UsageError
const RosModule& ModuleForUser() try { return Module(); } catch (const ModuleError& error) {
  throw UsageError(error.what());
}

// @throws SourceError
const RosModule& ModuleForSource(const std::string& source) try {
  return Module();
} catch (const ModuleError& error) {
  throw SourceError(source + ": " + error.what());
}

// Makes the bridge of `--ros auto` once the module and what it needs are there.
class BridgeWhenThere {
 public:
  BridgeWhenThere(BridgeConfig config, std::string problem)
      : config_(std::move(config)), problem_(std::move(problem)) {}

  std::unique_ptr<RosBridge> operator()() try {
    const RosModule& module = Module();
    spdlog::info("ROS is used now: {}", FindModule(kFile).string());
    return module.make_bridge(config_, RosMode::kAuto);
  } catch (const ModuleError& error) {
    if (problem_ != error.what()) Warn(error);
    problem_ = error.what();
    return nullptr;
  }

  static void Warn(const ModuleError& error) {
    spdlog::warn("ROS is not used yet: {}; tried again every {} s", error.what(),
                 kLookEvery.count());
  }

 private:
  BridgeConfig config_;
  std::string problem_;  // the last one, which has been logged
};

}  // namespace

void TakeRosArguments(int& argc, char** argv, const std::string& default_name) {
  HostProgram& program = Program();
  program.default_name = default_name;
  char** const first = argv + std::min(argc, 1);
  char** const taken = std::stable_partition(first, argv + argc, [](const char* argument) {
    return std::strstr(argument, ":=") == nullptr;
  });
  program.arguments.insert(program.arguments.end(), taken, argv + argc);
  argc = static_cast<int>(taken - argv);
}

std::vector<std::string> TakenRosArguments() {
  const std::vector<std::string>& all = Program().arguments;
  return {all.begin() + 1, all.end()};
}

bool BuiltWithRos() { return kBuiltWithRos; }

std::string MasterUri() { return kBuiltWithRos ? ModuleForUser().master_uri() : ""; }

bool MasterIsReachable() { return kBuiltWithRos && ModuleForUser().master_is_reachable(); }

const std::map<std::string, NodeParameter>& PrivateParameters() try {
  return Module().private_parameters();
} catch (const ModuleError&) {  // MakeRosBridge reports it
  static const std::map<std::string, NodeParameter> kNone;
  return kNone;
}

std::vector<RunningNode> FindRunningNodes() { return ModuleForUser().find_running_nodes(); }

std::string FullNodeName(const std::string& name) { return ModuleForUser().full_node_name(name); }

std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& config, RosMode mode) {
  if (mode == RosMode::kOff) return nullptr;
  try {
    return Module().make_bridge(config, mode);
  } catch (const ModuleError& error) {
    if (mode == RosMode::kRequired || !kBuiltWithRos) {
      throw UsageError(std::string(error.what()) + ", or use --ros=off");
    }
    BridgeWhenThere::Warn(error);
    return std::make_unique<AwaitedBridge>(BridgeWhenThere(config, error.what()), kLookEvery);
  }
}

std::unique_ptr<Source> OpenBag(const std::string& path, const GraphView& view) {
  return ModuleForSource("bag '" + path + "'").open_bag(path, view);
}

bool IsGraphUrl(std::string_view url) { return StartsWith(url, "ros:"); }

std::unique_ptr<Source> OpenGraph(const std::string& url, const GraphView& view) {
  return ModuleForSource("source '" + url + "'").open_graph(url, view);
}

bool HasMaster(const Source& graph) { return Module().has_master(graph); }

std::string MissingInGraph(const Source& graph) { return Module().missing_in_graph(graph); }

}  // namespace kinescope::ros_bridge
