/// Publishes SceneState as ROS 1 topics, TF and robot_description (docs/ros.md). No ROS type
/// appears here: ROS itself is in a module (ros_module.h), without which these functions report
/// what is missing.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/force_inputs.h"
#include "core/graph_view.h"
#include "core/mesh_files.h"
#include "core/person_change.h"
#include "core/scene_marker.h"
#include "core/scene_state.h"

namespace kinescope::ros_bridge {

enum class RosMode { kOff, kAuto, kRequired };  // auto: publish while a master is reachable

/// Of an order that came over ROS.
struct RosAnswer {
  bool is_done = false;
  std::string text;  // the file that was made, or why not: one line
};

/// What other nodes may order. Both or none; called on a thread of their own, they may wait.
struct RosOrders {
  std::function<RosAnswer()> snapshot;        // `~snapshot`
  std::function<RosAnswer(bool run)> record;  // `~record`
};

/// What may change while the node runs, by dynamic_reconfigure.
struct LiveSettings {
  std::array<double, 2> class_limits = kDefaultClassLimits;
  // of the first person:
  double mass_kg = 0, height_m = 0;
  urdf::Sex sex = urdf::Sex::kMale;
  std::string camera;  // of the live picture; "" without pictures

  bool operator==(const LiveSettings& other) const {
    return class_limits == other.class_limits && mass_kg == other.mass_kg &&
           height_m == other.height_m && sex == other.sex && camera == other.camera;
  }
  bool operator!=(const LiveSettings& other) const { return !(*this == other); }
};

/// nullopt: as before.
struct SettingsChange {
  std::optional<std::array<double, 2>> class_limits;
  PersonChange person;  // the first one
  std::optional<std::string> camera;
};

/// Both or none; called on the thread of RosOrders, they may wait.
struct RosSettings {
  std::function<std::optional<LiveSettings>()> get;  // nullopt: not now
  /// What cannot be changed is said in the answer; the rest is changed.
  std::function<RosAnswer(const SettingsChange&)> change;
  std::vector<std::string> cameras;  // to choose from; empty without pictures
};

struct BridgeConfig {
  std::string reference_frame = "world";  // parent of every TF, header.frame_id of poses
  /// Without people, the scene stands in the root of TF if that lacks the reference frame: of a
  /// graph, whose people may come later or not at all.
  bool finds_frame = false;
  std::string tf = "flat";  // "flat" as xsens_mvn_ros, "tree", "off" (the pelvis
                            // alone, for robot_state_publisher) or "none"
  /// Another node publishes the people. With "none", the frames of the links inside the joints are
  /// added where that node does not: RViz reports an error for a robot without them. What was told
  /// about the people is that node's to say.
  bool people_are_of_graph = false;
  std::string joint_states = "computed";  // or "streamed": type 20 with the mapping of
                                          // xsens_mvn_ros

  /// Parameter of the first person's URDF; "": robot_description, or human_description where
  /// another program has set that.
  std::string description;
  /// Whose URDF that parameter has until the first person appears; null: not set until then. RViz
  /// reads it once when it starts, which with one launch file is before the first sample.
  std::shared_ptr<const PersonModel> initial_model;
  /// Serves meshes while they exist, as http://<this computer>:<port>/<set>/<file>; returns the
  /// port, or 0 if it cannot. Called on another thread, when a URDF is published under a name by
  /// which other computers reach this one. Null: URDFs name the files of this computer.
  std::function<int(const std::string& set, const std::shared_ptr<const MeshFiles>& files)>
      serve_meshes;

  /// Factor for moments of external joint loads: -1 if the other program means the moment that the
  /// child exerts on the parent.
  double external_scale = 1;
  /// Why a hand load is rejected, "" if it is accepted. Null: all are accepted.
  std::function<std::string(const HandLoad&)> check_hand_load;
  RosOrders orders;        // null functions: no services
  RosSettings settings;    // null functions: nothing may change
  GraphView shown;         // of other nodes, beside the people
  bool with_view = false;  // advertises `~view/image_raw`; its owner must render it
};

/// A picture for `~view/image_raw` and its camera.
struct RosImage {
  int width = 0, height = 0;              // px
  const std::vector<std::uint8_t>& rgba;  // (height, width, 4), top row first; opaque
  std::int64_t stamp_nanos = 0;           // ns, of the sample that it shows; 0 before the first
  urdf::Pose world_from_optical;  // camera frame: z forward, x to the right, y down (REP 103)
  double focal_px = 0;  // focal length of a pinhole camera, px, its axis in the middle of the
                        // picture; 0: not a pinhole camera
};

/// How one thing is, for `/diagnostics`.
struct Diagnosis {
  enum class Level : std::uint8_t { kOk = 0, kWarning = 1, kError = 2, kStale = 3 };
  Level level = Level::kOk;
  std::string name;     // of the thing: "stream"; the node's name is put before it
  std::string message;  // one line
  std::vector<std::pair<std::string, std::string>> values;
};

/// A mark, for `~marks`.
struct RosMark {
  std::uint64_t id = 0, revision = 0;
  std::uint8_t button = 0;
  std::string text, role;
  std::int64_t stamp_nanos = 0;                 // of its sample
  std::uint32_t counter = 0;                    // of its sample
  std::optional<std::int64_t> end_stamp_nanos;  // of a span
  bool is_open = false, is_removed = false;
};

/// A line of the log, for `/rosout`.
struct RosLogLine {
  enum class Level : std::uint8_t { kDebug = 1, kInfo = 2, kWarning = 4, kError = 8 };
  Level level = Level::kInfo;
  std::string text;
};

/// Counters of one input topic.
struct InputCounters {
  std::uint64_t received = 0, used = 0;
  std::map<std::string, std::uint64_t> refused;  // rejected, by kind: "not a number"
  std::uint64_t unknown_joints = 0;              // joints in messages that are unknown
  std::uint64_t skewed = 0;    // stamps more than kMaxSkewSecs off the newest sample's stamp
  double worst_skew_secs = 0;  // the worst of those, s; positive: later than the sample
  std::string last_problem;    // with its values; "" without a problem
};
/// Beyond this the clocks disagree, which is reported; a measurement more than half a second off is
/// never used.
inline constexpr double kMaxSkewSecs = 0.2;

struct BridgeStatus {
  bool master_reachable = false;  // at the last check; checked once a second
  std::string master_uri;
  std::uint64_t published = 0;       // samples passed to ROS
  std::uint64_t missed = 0;          // samples that arrived before their topics were registered
  std::uint64_t master_returns = 0;  // times the topics were registered again at a restarted master
  /// `rosnode kill`, or another node took this node's name: nothing is published any more. A
  /// program without another task should end.
  bool shutdown_requested = false;
  std::map<std::string, InputCounters> inputs;  // by topic, as "hand_wrench/right"
  std::string frame;  // in which the scene stands: the reference frame, or the root of TF
  std::vector<std::string> not_shown;  // of --marker_topics, now: "/cloud: no node publishes it"
  /// Answers of the master and requests to this node that were rejected, by reason
  /// (xmlrpc_limits.h).
  std::map<std::string, std::uint64_t> rejected_calls;
};

/// Receives the inputs from ROS, on the thread that calls RosBridge::TakeInputs.
class InputSink {
 public:
  virtual ~InputSink() = default;
  virtual void OnHandLoad(int character, const HandLoad& load) = 0;
  virtual void OnMeasurements(int character, const Measurements& measured) = 0;
  /// All current external markers, in the world frame; called when the list has changed.
  virtual void OnMarkers(const MarkerList& /*markers*/) {}
  /// The newest pictures of cameras; called when one has come.
  virtual void OnImages(const ImageList& /*images*/) {}
  /// All robots that the graph moves, in the world frame; called when one has moved.
  virtual void OnRobots(const RobotList& /*robots*/) {}
  /// Where the frame is that the camera goes with, in the world frame; called when it has moved.
  virtual void OnCameraBase(const urdf::Pose& /*pose*/) {}
  /// A text on `~mark`: what the newest sample is to be marked with.
  virtual void OnMark(const std::string& /*text*/) {}
  /// The number of subscribers of the view; each new one needs a picture at once.
  virtual void OnViewListeners(int /*count*/) {}
};

/// Publishes each state once, on the thread that made it; never blocks on the master. The
/// destructor unregisters the topics. roscpp allows one node per process: make one bridge, once.
class RosBridge {
 public:
  virtual ~RosBridge() = default;
  RosBridge(const RosBridge&) = delete;
  RosBridge& operator=(const RosBridge&) = delete;

  /// One message per topic and person, all with the stamp of the person's sample. A sample with the
  /// counter and stamp of an earlier one is not published again, and no motion is published from a
  /// state that is not live. When a stream stops, its markers turn grey once. Call it on one
  /// thread.
  virtual void Publish(const SceneState& state) = 0;

  /// Passes on the inputs received on topics and services since the last call; never waits. Call it
  /// on the thread of Publish: before each sample, and regularly while none arrive.
  virtual void TakeInputs(InputSink& sink) = 0;
  virtual BridgeStatus status() const = 0;  // any thread

  /// Publishes `all` on `/diagnostics`, and how the published samples compare with `suit_hz`, the
  /// rate at which the suit sends (0: unknown); nothing until a master has answered. Never blocks;
  /// call it on the thread of Publish, as the next three.
  virtual void PublishDiagnostics(std::vector<Diagnosis> all, double suit_hz) = 0;
  /// Publishes what the stream is, on `~state`, which is latched. False until a master has
  /// answered.
  virtual bool PublishState(const std::string& state) = 0;
  /// False while nothing listens to `/rosout`.
  virtual bool PublishLog(const RosLogLine& line) = 0;
  /// Publishes a mark that is new or has changed. False until a master has answered.
  virtual bool PublishMark(const RosMark& mark) = 0;

  /// Publishes a picture to the subscribers of the view. Call it on one thread, which may be any;
  /// never blocks on the master.
  virtual void PublishView(const RosImage& picture) = 0;

 protected:
  RosBridge() = default;
};

/// Removes the ROS remappings (`a:=b`, `__name:=b`, `_param:=b`) from argv and keeps them for
/// roscpp. Call it first in main, whether the command uses ROS or not. `default_name`: node name
/// unless __name:= sets another.
void TakeRosArguments(int& argc, char** argv, const std::string& default_name);

/// Those that TakeRosArguments removed, for a program that takes this one's place.
std::vector<std::string> TakenRosArguments();

bool BuiltWithRos();

// The first of the following functions loads the module and starts roscpp with these arguments; a
// process that calls none of them does not touch ROS. @throws UsageError if ROS_MASTER_URI or a
// name is invalid, or if the module cannot be loaded.

std::string MasterUri();   // "" in a build without ROS
bool MasterIsReachable();  // contacts it, waits at most a second

/// A private parameter of this node.
struct NodeParameter {
  enum class Kind {
    kText,    // or a number; one text
    kSwitch,  // one text: "true" or "false". YAML reads an unquoted on or off as this
    kList,    // of texts, numbers and switches
    kOther,   // a map, or a list with something else in it; no texts
  };
  Kind kind = Kind::kText;
  std::vector<std::string> texts = {};
};

/// The private parameters, by name without "~": from `_name:=value` on the command line, else from
/// the master; those of the command line alone if no master answers within 2.4 s, which is logged.
/// The master is asked once, at the first call. None without the module. Any thread.
const std::map<std::string, NodeParameter>& PrivateParameters();

/// Null for kOff. For kAuto without the module: a bridge that publishes once the module can be
/// loaded.
/// @throws UsageError for an invalid config, for kRequired without a master or without the module,
/// or in a build without ROS.
[[nodiscard]] std::unique_ptr<RosBridge> MakeRosBridge(const BridgeConfig& config, RosMode mode);

}  // namespace kinescope::ros_bridge
