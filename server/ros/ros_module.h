/// The module that has all of ROS, `libkinescope_ros.so`: programs link no ROS library and load it
/// when the first function of bridge.h, running.h or source/ needs it. ros_module.cc defines these
/// functions for programs, which pass on to the table below; ros_module_entry.cc makes the table of
/// those that do the work. See core/system/module_loader.h.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/graph_view.h"
#include "core/source.h"
#include "core/system/module_loader.h"
#include "server/ros/bridge.h"
#include "server/ros/running.h"

namespace kinescope::ros_bridge {

/// What the module has to know of the program: it has a copy of its own of each variable of `core`
/// and `urdf`. Loggers are in spdlog's shared library, so both have the same. SetMonotonicClock
/// does not reach the module, whose bags do not read that clock; a server that sets it uses no
/// graph.
struct HostProgram {
  std::vector<std::string> arguments;  // the program, and what TakeRosArguments removed
  std::string default_name;
  bool (*stop_requested)() = nullptr;
  std::mutex* urdfdom = nullptr;
};

struct RosModule {
  ModuleAbi<HostProgram, urdf::AddedMass, BodySample, BridgeConfig, BridgeStatus, CameraImage,
            Character, urdf::Collision, Diagnosis, Ghost, GraphRobot, GraphView, HandLoad,
            InputCounters, JointLoad, urdf::Landmark, LeftOutPerson, urdf::Link, LiveSettings,
            Measurements, urdf::MeshNotFound, urdf::MeshSearch, NodeClock, NodeParameter,
            ObjectsSample, PersonModel, PersonState, Playback, urdf::Pose, RecordedSurroundings,
            urdf::RobotJoint, urdf::RobotModel, RobotState, RosAnswer, RosImage, RosLogLine,
            RosMark, RunningNode, RunningPerson, ScaledSegment, SceneMarker, SceneState,
            SettingsChange, ShownTopic, SourceCounters, SourceMoment, TrackedObject, urdf::Visual>
      abi;
  void (*start)(const HostProgram& program);  // once, before all others
  std::string (*master_uri)();
  bool (*master_is_reachable)();
  const std::map<std::string, NodeParameter>& (*private_parameters)();
  std::unique_ptr<RosBridge> (*make_bridge)(const BridgeConfig& config, RosMode mode);
  std::vector<RunningNode> (*find_running_nodes)();
  std::string (*full_node_name)(const std::string& name);
  std::unique_ptr<Source> (*open_bag)(const std::string& path, const GraphView& view);
  std::unique_ptr<Source> (*open_graph)(const std::string& url, const GraphView& view);
  bool (*has_master)(const Source& graph);
  std::string (*missing_in_graph)(const Source& graph);
};

/// Name of the module's entry: an `extern "C"` function without arguments -> const RosModule*.
inline constexpr const char* kRosEntry = "KinescopeRosModule";

}  // namespace kinescope::ros_bridge
