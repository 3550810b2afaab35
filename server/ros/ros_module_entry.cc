// The table of ros_module.h, in the module.
#include "core/system/stop_signal.h"
#include "server/ros/ros_module.h"
#include "server/ros/source/bag_source.h"
#include "server/ros/source/graph_source.h"
#include "urdf/robot/urdfdom_lock.h"

namespace kinescope::ros_bridge {
namespace {

void Start(const HostProgram& program) {
  std::vector<std::string> words = program.arguments;
  std::vector<char*> argv;
  argv.reserve(words.size());
  for (std::string& word : words) argv.push_back(word.data());
  int argc = static_cast<int>(argv.size());
  TakeRosArguments(argc, argv.data(), program.default_name);
  FollowStopRequestsOf(program.stop_requested);
  urdf::UseUrdfdomMutexOf(*program.urdfdom);
}

}  // namespace
}  // namespace kinescope::ros_bridge

extern "C" __attribute__((visibility("default"))) const void* KinescopeRosModule() {
  using namespace kinescope::ros_bridge;
  static const RosModule module = {{},
                                   Start,
                                   MasterUri,
                                   MasterIsReachable,
                                   PrivateParameters,
                                   MakeRosBridge,
                                   FindRunningNodes,
                                   FullNodeName,
                                   OpenBag,
                                   OpenGraph,
                                   HasMaster,
                                   MissingInGraph};
  return &module;
}
