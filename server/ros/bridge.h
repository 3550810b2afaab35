/// SceneState -> ROS 1 topics, TF, robot_description (docs/ros.md). No ROS type shows here, so a
/// build without ROS has the same header and a MakeRosBridge that says what is missing.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/force_inputs.h"
#include "core/scene_marker.h"
#include "core/scene_state.h"

namespace kinescope::ros_bridge {

enum class RosMode { kOff, kAuto, kRequired };  // auto: publish whenever a master is there

struct BridgeConfig {
  std::string reference_frame = "world";  // parent of every TF, header.frame_id of poses
  std::string tf = "flat";                // "flat" as the seed, "tree" or "off"
  std::string joint_states = "computed";  // or "streamed": type 20 with the seed's mapping

  /// What robot_description holds until somebody is seen; "": not set until then. RViz looks for it
  /// once, when it starts, which with one launch file is before the first sample.
  std::string initial_urdf;

  /// Multiplies the moments that another program publishes: -1 where it means what the child exerts
  /// on the parent.
  double external_scale = 1;
  /// "" or what is wrong with a hand load that somebody wants to set. Null: all are taken.
  std::function<std::string(const HandLoad&)> check_hand_load;
  std::string markers;     // topics of other programs' markers, with commas between
  bool with_view = false;  // `~view/image_raw` is there; who advertises it has to draw
};

/// A picture on its way to `~view/image_raw`, and the camera that took it.
struct ViewPicture {
  int width = 0, height = 0;              // px
  const std::vector<std::uint8_t>& rgba;  // (height, width, 4), top row first; opaque
  std::int64_t stamp_nanos = 0;           // of the sample it shows; 0 before the first
  urdf::Pose world_from_optical;          // z forward, x to the right, y down (REP 103)
  double focal_px = 0;  // of the pinhole in the picture's middle; 0: it is none of one pinhole
};

/// What came on one input topic.
struct InputCounters {
  std::uint64_t received = 0, used = 0;
  std::map<std::string, std::uint64_t> refused;  // by kind: "not a number"
  std::uint64_t unknown_joints = 0;              // named in messages, none of ours
  std::uint64_t skewed = 0;    // stamps more than kMostSkewSecs off the newest sample's
  double worst_skew_secs = 0;  // of those; positive: later than the sample
  std::string last_problem;    // with its values; "" while there was none
};
/// More than that and clocks disagree, which is reported; what is off by more than half a second is
/// never fresh.
inline constexpr double kMostSkewSecs = 0.2;

struct BridgeStatus {
  bool master_reachable = false;  // when last asked; asked once a second
  std::string master_uri;
  std::uint64_t published = 0;       // samples handed to ROS
  std::uint64_t missed = 0;          // samples that came before their topics could be announced
  std::uint64_t master_returns = 0;  // times the topics were announced anew to a restarted master
  /// `rosnode kill`, or another node took our name: nothing is published any more. A program that
  /// has nothing else to do should end.
  bool told_to_stop = false;
  std::map<std::string, InputCounters> inputs;  // by topic, as "hand_wrench/right"
};

/// Takes what was told over ROS, on the thread that calls RosBridge::TakeInputs.
class InputSink {
 public:
  virtual ~InputSink() = default;
  virtual void OnHandLoad(int character, const HandLoad& load) = 0;
  virtual void OnMeasurements(int character, const Measurements& measured) = 0;
  /// All that other programs show now, placed; comes when it is another list than before.
  virtual void OnMarkers(const std::vector<std::shared_ptr<const SceneMarker>>& /*markers*/) {}
  /// So many now want to see pictures of the view; each that comes wants one at once.
  virtual void OnViewListeners(int /*count*/) {}
};

/// Publishes each state once, from the thread that made it; never blocks on the master. Destroying
/// it takes the topics back. roscpp has one node per process: make one bridge, once.
class RosBridge {
 public:
  virtual ~RosBridge() = default;
  RosBridge(const RosBridge&) = delete;
  RosBridge& operator=(const RosBridge&) = delete;

  /// One message per topic and person, all with the stamp of the person's sample. A sample that was
  /// published before (same counter and stamp) is not published again, and no motion comes from a
  /// state that is not live; when a stream stops, its markers turn grey once. One thread calls it.
  virtual void Publish(const SceneState& state) = 0;

  /// Hands on what has come on the input topics and services since the last call; waits for
  /// nothing. The same thread as Publish: before each sample, and now and then while none come.
  virtual void TakeInputs(InputSink& sink) = 0;
  virtual BridgeStatus status() const = 0;  // any thread

  /// To whoever listens to the view. One thread, any; never blocks on the master.
  virtual void PublishView(const ViewPicture& picture) = 0;

 protected:
  RosBridge() = default;
};

/// Takes the ROS remappings (`a:=b`) out of argv. Call first in main. Does not talk to a master.
/// `default_name`: node name unless __name:= says otherwise.
/// @throws UsageError when ROS_MASTER_URI or a name cannot be used.
void InitRos(int& argc, char** argv, const std::string& default_name);

bool BuiltWithRos();

// The following need InitRos first, where built with ROS.

std::string MasterUri();   // "" when built without ROS
bool MasterIsReachable();  // asks it, waits at most a second

/// The private parameter `~name` as text: what `_name:=value` said on the command line, else what
/// the master holds. nullopt when neither has it, when it is a list or a map, or when no master is
/// there. The master is asked once, at the first call. Any thread.
std::optional<std::string> PrivateParameter(const std::string& name);

/// Null for kOff.
/// @throws UsageError for a bad config, for kRequired without a master, or when built without ROS.
[[nodiscard]] std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& config, RosMode mode);

}  // namespace kinescope::ros_bridge
