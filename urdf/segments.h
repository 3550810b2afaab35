/// The 23 segments and 22 joints of an MVN body: order, names, parents. This is the only table of
/// them in the program; every per-segment array is indexed by `Segment`, every per-joint array by
/// `Joint`.
///
/// Frames. A *segment* frame is the one that MVN streams: identity in the T-pose, x forward, y
/// left, z up, so the right arm lies along -y. A *link* frame is the one that Kinescope publishes
/// (TF, URDF, as xsens_mvn_ros does). It is the segment frame, except that upper arms, forearms and
/// hands are rotated so that identity is the N-pose and every limb points along -z. The origins are
/// equal: the proximal joint centre (pelvis: midpoint of the hips). Source of order, names and
/// rotations: MV0305P and xsens_mvn_ros (mvn-protocol.md 4.1, 4.3, 6.1).
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace kinescope::urdf {

constexpr int kSegmentCount = 23;
constexpr int kJointCount = 22;

/// Value = MVN segment id - 1.
enum Segment : int {
  kPelvis,
  kL5,
  kL3,
  kT12,
  kT8,
  kNeck,
  kHead,
  kRightShoulder,
  kRightUpperArm,
  kRightForeArm,
  kRightHand,
  kLeftShoulder,
  kLeftUpperArm,
  kLeftForeArm,
  kLeftHand,
  kRightUpperLeg,
  kRightLowerLeg,
  kRightFoot,
  kRightToe,
  kLeftUpperLeg,
  kLeftLowerLeg,
  kLeftFoot,
  kLeftToe,
};

/// Value = MVN joint number - 1; the child of joint j is segment j + 1.
enum Joint : int {
  jL5S1,
  jL4L3,
  jL1T12,
  jT9T8,
  jT1C7,
  jC1Head,
  jRightC7Shoulder,
  jRightShoulder,
  jRightElbow,
  jRightWrist,
  jLeftC7Shoulder,
  jLeftShoulder,
  jLeftElbow,
  jLeftWrist,
  jRightHip,
  jRightKnee,
  jRightAnkle,
  jRightBallFoot,
  jLeftHip,
  jLeftKnee,
  jLeftAnkle,
  jLeftBallFoot,
};

/// Joints that have the same ranges, strengths and size, on both sides.
enum class JointGroup {
  kSpine,  // L5/S1 to T9/T8
  kNeck,   // T1/C7 and C1/head
  kClavicle,
  kShoulder,
  kElbow,
  kWrist,
  kHip,
  kKnee,
  kAnkle,
  kBallOfFoot,
};
constexpr std::size_t kJointGroupCount = 10;

struct SegmentInfo {
  std::string_view mvn_name;   // "RightForeArm", as in type 13 and MVNX
  std::string_view link_name;  // "right_forearm", as xsens_mvn_ros publishes it
  int parent;                  // -1 for the pelvis
};

struct JointInfo {
  std::string_view mvn_name;  // "jRightC7Shoulder" (jRightT4Shoulder in newer files)
  std::string_view ros_name;  // "right_c7_shoulder"
  std::string_view label;     // "Right C7 shoulder", for display
};

extern const std::array<SegmentInfo, kSegmentCount> kSegments;
extern const std::array<JointInfo, kJointCount> kJoints;

/// The joints whose load is computed and shown: L5/S1, T9/T8, neck (T1/C7), then shoulder, elbow,
/// wrist, hip, knee, ankle, right before left.
inline constexpr std::size_t kScoredJointCount = 15;
extern const std::array<int, kScoredJointCount> kScoredJoints;
inline constexpr std::size_t kScoredL5S1 = 0;  // index of L5/S1, which has a compression too

/// A segment or joint as an array index.
constexpr std::size_t At(int index) { return static_cast<std::size_t>(index); }

constexpr int ChildOf(int joint) { return joint + 1; }
inline int ParentOf(int joint) {
  return kSegments[At(joint) + 1].parent;  // of the child segment
}

JointGroup JointGroupOf(int joint);
constexpr std::size_t At(JointGroup group) { return static_cast<std::size_t>(group); }

constexpr bool IsLeftJoint(int joint) {
  return (joint >= jLeftC7Shoulder && joint <= jLeftWrist) || joint >= jLeftHip;
}

/// The segment with the MVN name `mvn_name`; nullopt for a prop, a finger or an unknown name.
std::optional<Segment> FindSegment(std::string_view mvn_name);
/// The joint with the MVN name `mvn_name`; `j·T4Shoulder` (files since MVN 2018) is `j·C7Shoulder`.
std::optional<Joint> FindJoint(std::string_view mvn_name);

/// The constant rotation between the two frames of a segment:
/// world_from_link = world_from_segment * SegmentFromLink(segment). Rx(-90 deg) for the right upper
/// arm, forearm and hand, Rx(+90 deg) for the left ones, identity elsewhere.
const Eigen::Quaterniond& SegmentFromLink(int segment);

}  // namespace kinescope::urdf
