/// What every sink shows: RViz, picture, clip, page and golden check all draw from this value and
/// compute nothing of their own about the human. Made once per sample
/// (server/scene/scene_builder.h), never changed afterwards, shared as `std::shared_ptr<const
/// SceneState>`. World frame: z up, metres. Poses are of *link* frames (urdf/segments.h).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/body_forces.h"
#include "core/body_sample.h"
#include "core/scene_marker.h"
#include "urdf/human_urdf.h"
#include "urdf/kinematics.h"
#include "urdf/mesh_uri.h"
#include "urdf/rigid_deviation.h"
#include "urdf/robot_model.h"

namespace kinescope {

enum class LoadClass { kUnknown = 0, kLow = 1, kMedium = 2, kHigh = 3 };

/// "unknown", "low", "medium", "high".
const char* Name(LoadClass load_class);

/// One load sphere. The joints that get one: kScoredJoints (server/loads). Texts live as long as
/// the program.
struct JointLoad {
  int joint = 0;                                       // urdf::Joint
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // of the joint centre, world, m
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();    // N m, parent on child, world axes
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     // N, likewise
  double ratio = 0;                                    // of capacity; NaN where unknown
  double deciding_moment = 0;                          // N m, signed, of the channel that decides
  double capacity = 0;                                 // N m, of that channel
  std::string_view channel;                            // "flexion", "elevation", ...
  LoadClass load_class = LoadClass::kUnknown;
  bool class_is_of_compression = false;  // L5/S1: its compression is worse than its moment
  bool is_external = false;              // moment, ratio or class come from another program
  /// Time spent in each class so far, s, by LoadClass; the exposure of this run or clip.
  std::array<double, 4> class_secs{};
  std::string_view reason;  // why unknown; "" otherwise
};

/// The person as a mechanism. Shared by all states until scale data change it.
struct PersonModel {
  urdf::HumanModel human;
  urdf::BodyDescription description;
  bool lengths_are_measured = false;  // the source told them; else: a default body of some height
  std::string urdf_xml;               // what robot_description holds
  urdf::RobotModel robot;             // the same, read back
  std::uint64_t revision = 0;         // grows with every change; sinks reload when it does
};

/// A gloved hand, complete: what the sample lacks is where it was last against the rest.
struct GloveState {
  urdf::FingerPoses links{};    // world_from_link
  urdf::FingerAngles angles{};  // rad, from the poses
};

struct PropState {
  urdf::Pose pose;                                   // world_from_prop
  Eigen::Vector3d angles = Eigen::Vector3d::Zero();  // against the pelvis, as kinematics.h, rad
};

struct PersonState {
  int character = 0;
  std::string name;
  std::shared_ptr<const PersonModel> model;  // never null
  BodySample sample;                         // as it came
  urdf::LinkPoses links{};                   // world_from_link
  urdf::JointAngles angles{};                // rad, from the poses
  /// Of what model->human has: by urdf::Side, and by number.
  std::array<std::optional<GloveState>, 2> gloves;
  std::array<std::optional<PropState>, kMostProps> props;
  urdf::RigidDeviation deviation;        // of the URDF's rigid body from `links`
  urdf::RigidDeviation worst_deviation;  // so far, of this skeleton
  std::optional<Eigen::Vector3d> com;    // MVN's where streamed, else the body model's
  bool com_is_ours = false;
  std::optional<Eigen::Vector3d> cop;  // on the floor; absent when not computable
  std::vector<JointLoad> loads;        // in order of kScoredJoints
  BodyForces forces;
};

/// A thing that is tracked beside the people (mvn-protocol.md 4.2), in its own frame as streamed.
struct TrackedObject {
  int character = 0;  // that it streams as
  int number = 0;     // within that, from 0; with it the object's identity
  std::string name;   // from scale data, else "object_1"
  urdf::Pose pose;    // world_from_object
  std::int64_t stamp_nanos = 0;
};

/// Any robot from a URDF, beside the people.
struct RobotState {
  std::string name;
  std::shared_ptr<const urdf::RobotModel> model;  // never null
  std::shared_ptr<const urdf::MeshSearch>
      meshes;  // where its meshes are; null: absolute names only
  std::vector<Eigen::Isometry3d> world_from_link;  // in the order of model->links
                                                   // (urdf::PlaceLinks)
  Eigen::AlignedBox3d bounds;  // of what is drawn of it (render::Renderer::Bounds), world; empty:
                               // not known
};

enum class Liveness {
  kNoData,  // nothing came yet
  kLive,
  kStale,  // the stream stopped: poses are old, loads are unknown
};

/// "no data", "live", "stale".
const char* Name(Liveness liveness);

struct SceneState {
  Liveness liveness = Liveness::kNoData;
  std::uint64_t number = 0;      // of this state, +1 each; tells sinks apart what they have seen
  std::int64_t stamp_nanos = 0;  // of the newest sample, ROS time; 0 before the first
  std::uint32_t counter = 0;     // its sample counter
  std::int64_t time_code_millis = 0;  // its time code
  std::int64_t arrival_nanos = 0;     // monotonic; 0 for files
  double rate_hz = 0;                 // of samples, measured over the last second (file: nominal)
  /// Of capacity: above the first a load is medium, above the second high, while it rises.
  std::array<double, 2> class_limits{{0.30, 0.60}};
  double floor_z = 0;                  // height of the ground, world, m
  std::string source;                  // "udp://0.0.0.0:9763"
  std::vector<PersonState> people;     // one per character seen within the last second
  std::vector<TrackedObject> objects;  // likewise
  std::vector<RobotState> robots;
  /// What other programs want to be seen. Shared, so that one that stays costs nothing again: a
  /// changed marker is a new one. Never null; one with a defect is named and not drawn.
  std::vector<std::shared_ptr<const SceneMarker>> markers;
};

}  // namespace kinescope
