/// Holds one sample of a captured body: the value that every source produces.
/// World frame: right-handed, z up, metres; x forward and y left at calibration. Orientations are
/// those of *segment* frames (identity in the T-pose), as MVN streams them; see urdf/segments.h.
/// Plain data that may be copied to any thread.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/finger_and_prop_segments.h"
#include "core/hand_load.h"
#include "core/person_change.h"
#include "urdf/anatomical_angles.h"
#include "urdf/landmarks.h"
#include "urdf/segments.h"
#include "urdf/skeleton.h"

namespace kinescope {

struct SegmentState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // of the segment's origin, world, m
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_segment, unit
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();               // of the origin, world, m/s
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();           // without gravity, world, m/s^2
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();       // world axes, rad/s
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();   // world axes, rad/s^2
};

struct CenterOfMass {  // computed by the sender (type 24, MVNX centerOfMass); world
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      // m
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      // m/s, zero where not sent
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // m/s^2, zero where not sent
  bool has_derivatives = false;
};

/// One inertial sensor of the suit (type 23), by the segment that carries it.
struct TrackerState {
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  // world_from_sensor, unit
  Eigen::Vector3d free_acceleration = Eigen::Vector3d::Zero();      // world, no gravity, m/s^2
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();      // sensor axes, with gravity, m/s^2
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  // sensor axes, rad/s
  Eigen::Vector3d magnetic_field = Eigen::Vector3d::Zero();    // sensor axes, about 1
  bool has_rates = false;  // false: the sender omits acceleration and angular velocity
};

/// Foot contact as the sender reports it: which end of the foot is on the floor.
struct FootContactFlags {
  bool heel = false, forefoot = false;
};

struct BodySample {
  int character = 0;                  // id within the source, from 0
  std::uint32_t counter = 0;          // sender's sample counter; counts captured frames
  std::int64_t time_code_millis = 0;  // sender's clock: since its recording began
  std::int64_t stamp_nanos = 0;       // ROS time (Unix epoch) of this sample, ns
  bool has_time_of_day = true;        // false: stamp_nanos begins anywhere, only its steps count
  std::int64_t arrival_nanos = 0;  // receive time of its last datagram, monotonic clock; 0: from a
                                   // file
  std::array<SegmentState, urdf::kSegmentCount> segments{};
  bool has_linear = false;   // velocity and acceleration are measured; false: they are zeros
  bool has_angular = false;  // angular velocity and acceleration are measured; false: they are
                             // zeros
  std::optional<CenterOfMass> com;
  /// Joint angles as streamed (type 20, MVNX jointAngle), degrees, MVN's own (x, y, z) order.
  std::optional<std::array<Eigen::Vector3d, urdf::kJointCount>> streamed_angles_deg;
  /// By urdf::Side (MVNX footContacts); absent if the sender does not report contacts.
  std::optional<std::array<FootContactFlags, 2>> foot_contacts;
  FingerAndPropSegments fingers_and_props;  // gloves and props, where streamed
  std::array<TrackerState, urdf::kSegmentCount> trackers{};
  std::bitset<urdf::kSegmentCount> has_tracker;
  std::optional<std::int32_t> utc_millis_of_day;  // type 25: time of day, UTC, without a date
};

/// The poses of the sample, of *link* frames (urdf/segments.h), world.
urdf::Pose LinkPoseOf(const BodySample& sample, int segment);
urdf::LinkPoses LinkPosesOf(const BodySample& sample);

/// world_from_segment, as in the sample.
urdf::SegmentOrientations OrientationsOf(const BodySample& sample);

/// One sample of a group of tracked objects, which MVN streams as a separate character.
struct ObjectsSample {
  int character = 0;
  std::uint32_t counter = 0;
  std::int64_t time_code_millis = 0;
  std::int64_t stamp_nanos = 0;                         // as in BodySample
  std::int64_t arrival_nanos = 0;                       // as in BodySample
  std::array<urdf::Pose, urdf::kSegmentCount> poses{};  // by object number, world_from_object
  std::bitset<urdf::kSegmentCount> present;
};

/// A segment beyond the body's 23, as the scale data describe it.
struct ScaledSegment {
  std::string name;
  Eigen::Vector3d origin_in_world = Eigen::Vector3d::Zero();  // in the T-pose, m

  bool operator==(const ScaledSegment& other) const {
    return name == other.name && origin_in_world == other.origin_in_world;
  }
};

/// The properties of one person or group of objects that do not change with every sample. A source
/// delivers them again after each change.
struct Character {
  int id = 0;
  std::string name;                        // "" where unknown
  std::optional<std::uint32_t> color_rgb;  // 0xRRGGBB
  std::optional<urdf::Skeleton> skeleton;  // of a person; from type 13 or MVNX points
  urdf::Landmarks landmarks;               // that came with the skeleton, as read; empty: none came
  /// Of a person: props and fingers, indexed as FingerAndPropSegments; name "" where there is none.
  /// Of a group of objects: all of them, in order.
  std::vector<ScaledSegment> scaled_segments;
  /// Of a person of another node, or of its recording: what that node was told. Not checked.
  PersonChange told = {};
  HandLoad told_hand_load = {};
};

}  // namespace kinescope
