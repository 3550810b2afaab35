/// Computes joint angles as MVN writes them: clinical angles between anatomical (ISB) axes
/// (mvnx-format.md 5 to 7, mvn-protocol.md 4.5; equal to those of MVN 2023.2 within 1e-11 deg).
/// They are another value than the angles of the URDF's joints (urdf/kinematics.h). Pure functions,
/// any thread.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string_view>

#include "urdf/segments.h"

namespace kinescope::urdf {

/// world_from_isb = world_from_segment * SegmentFromIsb(segment): identity with the arms hanging
/// and the palms forward. Identity but for upper arms, forearms and hands.
const Eigen::Quaterniond& SegmentFromIsb(int segment);

/// The order of the turns: about which axis the angle is limited to 90 deg. ZXY is the one to show;
/// XZY suits shoulders at large elevations.
enum class AngleSequence { kZxy, kXzy };

using SegmentOrientations = std::array<Eigen::Quaterniond, kSegmentCount>;  // world_from_segment

/// (x, y, z), degrees: x abduction or lateral bending, y internal or axial rotation, z flexion;
/// with clinical signs on both sides.
std::array<Eigen::Vector3d, kJointCount> AnatomicalAngles(const SegmentOrientations& orientations,
                                                          AngleSequence sequence);

/// Inverse of AnatomicalAngles() with kZxy, of one joint: the rotation parent_from_child of the
/// segment frames. Of equal rotations AnatomicalAngles() returns the one with |x| <= 90 deg, and y
/// = 0 where |x| is 90 deg.
Eigen::Quaterniond RotationOfJoint(int joint, const Eigen::Vector3d& degrees);

/// The angles between segments that are not neighbours, and of the trunk against the vertical.
enum class ErgonomicAngle {
  kT8Head,
  kT8LeftUpperArm,
  kT8RightUpperArm,
  kPelvisT8,
  kVerticalPelvis,  // from an upright frame with the heading of the pelvis
  kVerticalT8,      // from the same frame
};
constexpr std::size_t kErgonomicAngleCount = 6;

struct ErgonomicAngleInfo {
  std::string_view name;    // "T8_LeftUpperArm", as in MVNX
  std::string_view parent;  // "T8"; "Vertical"
  int child;                // urdf::Segment
};
extern const std::array<ErgonomicAngleInfo, kErgonomicAngleCount> kErgonomicAngles;

/// As AnatomicalAngles, by ErgonomicAngle.
std::array<Eigen::Vector3d, kErgonomicAngleCount> ErgonomicAngles(
    const SegmentOrientations& orientations, AngleSequence sequence);

}  // namespace kinescope::urdf
