/// The value that all sinks show. RViz, pictures, clips, page and golden check read it and compute
/// nothing about the human themselves. Made once per sample (server/scene/scene_builder.h), never
/// changed afterwards, shared between threads as `std::shared_ptr<const SceneState>`. World frame:
/// z up, metres. Poses are of *link* frames (urdf/segments.h).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/body_forces.h"
#include "core/body_sample.h"
#include "core/camera_image.h"
#include "core/load_class.h"
#include "core/mesh_files.h"
#include "core/robot_state.h"
#include "core/scene_marker.h"
#include "core/suit_colors.h"
#include "urdf/human_urdf.h"
#include "urdf/kinematics.h"
#include "urdf/rigid_deviation.h"
#include "urdf/robot/robot_model.h"

namespace kinescope {

/// One load sphere. The joints with a load are urdf::kScoredJoints. Texts live as long as the
/// program.
struct JointLoad {
  int joint = 0;                                       // urdf::Joint
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // of the joint centre, world, m
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();    // N·m, parent on child, world axes
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     // N, parent on child, world axes
  double ratio = 0;            // of the capacity in this sample; NaN where unknown
  double shown_ratio = 0;      // what people see: `ratio` with a held peak; NaN where unknown
  double deciding_moment = 0;  // N·m, signed, in the governing direction
  double capacity = 0;         // N·m, in the governing direction
  std::string_view channel;    // the governing direction: "flexion", "elevation", ...
  /// The largest ratio of its moments; that of the governing direction unless a compression
  /// governs. NaN where unknown.
  double moment_ratio = std::numeric_limits<double>::quiet_NaN();
  /// The largest ratio of all other directions, and this direction; NaN and "" without another one.
  double next_ratio = std::numeric_limits<double>::quiet_NaN();
  std::string_view next_channel;
  LoadClass load_class = LoadClass::kUnknown;  // of shown_ratio, with hysteresis
  LoadClass band = LoadClass::kUnknown;        // of ratio: input of exposure
  bool is_of_compression = false;              // L5/S1: `ratio` is that of the compression force
  bool is_external = false;                    // moment, ratio or class are of another program
  /// Time in each band up to this sample, s, by LoadClass: the exposure of this run or clip.
  std::array<double, kLoadClassCount> band_secs{};
  std::string_view reason;  // why unknown; "" otherwise
};

/// The person as a mechanism. Shared by all states until the scale data change.
struct PersonModel {
  int index = 0;  // in the order in which people came; 0: the first, also when they are away
  urdf::HumanModel human;
  urdf::BodyDescription description;
  bool lengths_are_measured = false;  // from the source; else: the default body of a given height
  bool lengths_are_of_poses = false;  // measured in its poses, since it sends no lengths
  /// As the source sent them: the points that came with the lengths, and the person's colour,
  /// 0xRRGGBB. Empty: none came.
  urdf::Landmarks landmarks;
  std::optional<std::uint32_t> color_rgb;
  std::string urdf_xml;        // content of robot_description
  urdf::RobotModel robot;      // urdf_xml, parsed
  std::uint64_t revision = 0;  // increases with every change; sinks then reload
  /// Those that urdf_xml names, in a folder of their own; null without any. The files themselves
  /// exist after Provide() only.
  std::shared_ptr<const MeshFiles> mesh_files;
  /// The body's visuals are the built-in surface, so that it can be rendered as one skin.
  bool has_built_in_surface = false;
  SuitColors suit;  // of the skin
};

/// All segments of a gloved hand. A segment that the sample lacks keeps its last joint angles.
struct GloveState {
  urdf::FingerPoses links{};    // world_from_link
  urdf::FingerAngles angles{};  // rad, computed from the poses
};

struct PropState {
  urdf::Pose pose;                                   // world_from_prop
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();  // rad, relative to the pelvis; chain as in
                                                     // kinematics.h
};

struct PersonState {
  int character = 0;
  std::string name;
  std::shared_ptr<const PersonModel> model;  // never null
  BodySample sample;                         // as received
  urdf::LinkPoses links{};                   // world_from_link
  urdf::JointAngles angles{};                // rad, computed from the poses
  /// Exactly those of model->human: by urdf::Side, and by number of the prop.
  std::array<std::optional<GloveState>, 2> gloves;
  std::array<std::optional<PropState>, kMaxProps> props;
  urdf::RigidDeviation deviation;        // of the rigid body of the URDF from `links`
  urdf::RigidDeviation worst_deviation;  // largest so far with this skeleton
  std::optional<Eigen::Vector3d> com;    // world, m; MVN's where streamed, else the body model's
  bool com_is_ours = false;
  std::optional<Eigen::Vector3d> cop;  // on the floor, world, m; absent where unknown
  std::vector<JointLoad> loads;        // in the order of kScoredJoints
  BodyForces forces;
};

/// Characters of the people of SceneState::ghosts. MVN's are below 256.
inline constexpr int kFirstGhost = 1'000'000;

/// A reference pose: a second, translucent body.
struct Ghost {
  PersonState person;
  double opacity = 0.35;  // 0..1
  std::string name = {};  // for the legend; "": no entry
};

/// A tracked object beside the people (mvn-protocol.md 4.2), in its own frame as streamed.
struct TrackedObject {
  int character = 0;  // id of the character that carries it
  int number = 0;     // within the character, from 0; both identify the object
  std::string name;   // from the scale data, else "object_1"
  urdf::Pose pose;    // world_from_object
  std::int64_t stamp_nanos = 0;
};

enum class Liveness {
  kNoData,  // no sample received yet
  kLive,
  kStale,     // no new samples: poses are old, loads are unknown
  kNoPerson,  // the source lives, and has no person now: robots and what is about them
};

/// "no data", "live", "stale", "no person".
const char* Name(Liveness liveness);

/// Of SceneState::waited_nanos; below it, waiting is not worth a word.
inline constexpr std::int64_t kOverloadNanos = 250'000'000;

/// A person whose samples are not shown, because they cannot be right.
struct LeftOutPerson {
  int character = 0;
  std::string name;  // "" if none came
  std::string why;   // "900 km from the others"
};

struct SceneState {
  Liveness liveness = Liveness::kNoData;
  std::uint64_t number = 0;  // of this state, from one state to the next +1; sinks use it to detect
                             // new states
  std::int64_t stamp_nanos = 0;       // of the newest sample, ROS time; 0 before the first; with
                                      // kNoPerson the time of the source
  std::uint32_t counter = 0;          // of the newest sample
  std::int64_t time_code_millis = 0;  // of the newest sample, ms
  std::int64_t arrival_nanos = 0;     // receive time, monotonic clock; 0 for files
  std::int64_t made_nanos = 0;        // when a server took this state up, monotonic clock; else 0
  /// How long the newest sample waited in this machine before it was processed, ns; 0 for files.
  /// More than kOverloadNanos: this machine is overloaded, and all that is shown is that old.
  std::int64_t waited_nanos = 0;
  double rate_hz = 0;  // samples per second over the last second (file: nominal)
  std::array<double, 2> class_limits = kDefaultClassLimits;
  /// Below which a load of class medium and high falls back, where it once was above the limit.
  std::array<double, 2> class_falls_below = kDefaultClassFallsBelow;
  double floor_z = 0;  // height of the ground, world, m
  /// By which the named cameras of live pictures and of the page are turned about z, rad; 0 in
  /// scenes of files. Their "front" looks from there.
  double view_heading = 0;
  std::string source;                   // "udp://0.0.0.0:9763"
  std::vector<PersonState> people;      // one per character with a sample in the last second
  std::vector<LeftOutPerson> left_out;  // with a sample in the last second that is implausible
  std::vector<TrackedObject> objects;   // those with a sample in the last second
  std::vector<RobotState> robots;
  /// What the named cameras show while there is no person (scene_extent.h), held: it does not
  /// follow every movement. Empty: there is nothing, or there are people.
  Eigen::AlignedBox3d extent;
  /// world_from_frame of the frame that a placed camera goes with, where it was last; none: there
  /// is no such frame, or it had no place yet.
  std::optional<urdf::Pose> camera_base;
  /// Reference poses beside the people of a live scene. Their people have characters from
  /// kFirstGhost on, one for each.
  std::vector<Ghost> ghosts;
  /// Increases with every change of `robots` or `markers` but where a robot has its links; 0: there
  /// were none yet.
  std::uint64_t surroundings = 0;
  /// External markers. Shared, so that unchanged markers cost nothing; a changed marker is a new
  /// object. Never null. A marker with a defect is reported and not rendered.
  std::vector<std::shared_ptr<const SceneMarker>> markers;
  /// Pictures of cameras, beside the scene. None in former states.
  ImageList images;
};

}  // namespace kinescope
