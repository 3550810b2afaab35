/// SceneState -> ROS 1 topics, TF, robot_description (docs/ros.md). No ROS type shows here, so a build
/// without ROS has the same header and a MakeRosBridge that says what is missing.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "server/core/scene_state.h"

namespace kinescope::ros_bridge {

enum class RosMode { kOff, kAuto, kRequired };  // auto: publish whenever a master is there

struct BridgeConfig {
  std::string reference_frame = "world";  // parent of every TF, header.frame_id of poses
  std::string tf = "flat";                // "flat" as the seed, "tree" or "off"
  std::string joint_states = "computed";  // or "streamed": type 20 with the seed's mapping
};

struct BridgeStatus {
  bool master_reachable = false;
  std::string master_uri;
  std::uint64_t published = 0;          // samples
  std::uint64_t missed = 0;             // samples that came while no master was there
  std::uint64_t master_returns = 0;     // times the topics were announced anew
};

/// Publishes each state once, from the thread that made it; never blocks on the master.
class RosBridge {
 public:
  virtual ~RosBridge() = default;
  RosBridge(const RosBridge&) = delete;
  RosBridge& operator=(const RosBridge&) = delete;

  /// One message per topic and person, all with the state's stamp. States that are not live, or that
  /// carry no new sample (the counter and stamp of the last), are not published as motion.
  virtual void Publish(const SceneState& state) = 0;
  virtual BridgeStatus status() const = 0;

 protected:
  RosBridge() = default;
};

/// Takes the ROS remappings (`a:=b`) out of argv. Call first in main. Does not talk to a master.
/// `default_name`: node name unless __name:= says otherwise.
void InitRos(int& argc, char** argv, const std::string& default_name);

bool BuiltWithRos();
std::string MasterUri();       // "" when built without ROS
bool MasterIsReachable();      // asks it, waits at most a second

/// The private parameter `~name` as text; nullopt when not set or no master is there.
std::optional<std::string> PrivateParameter(const std::string& name);

/// @throws UsageError for a bad config, for kRequired without a master, or when built without ROS.
std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& config, RosMode mode);

}  // namespace kinescope::ros_bridge
