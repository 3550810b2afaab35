/// Reads a written pose: "t_pose,right_elbow=90,left_hip_abduction=20,heading=45". Joints, axes and
/// signs are those of the angles that `kinescope convert` writes (urdf/anatomical_angles.h, kZxy).
/// Pure functions, any thread.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "urdf/segments.h"

namespace kinescope::subject {

/// What can be written, by index: the three angles of each joint, then these.
enum WrittenQuantity : std::size_t {
  kPelvisBending = 3 * urdf::kJointCount,  // lateral, against the vertical, deg
  kPelvisFlexion,                          // forward, against the vertical, deg
  kHeading,                                // counter-clockwise from +x, deg
  kPlaceX,                                 // m
  kPlaceY,                                 // m
  kWrittenQuantities,
};

/// Index of an angle; axis 0 1 2 = abduction, rotation, flexion.
constexpr std::size_t AngleOf(int joint, int axis) {
  return 3 * urdf::At(joint) + static_cast<std::size_t>(axis);
}

struct WrittenPose {
  std::string base = "n_pose";                                     // one of StaticPoseNames()
  std::array<std::optional<double>, kWrittenQuantities> values{};  // nullopt: that of the base
  std::string text;  // the same without blanks: ParsePose(text) returns this pose
};

/// The longest text that is read.
inline constexpr std::size_t kMaxPoseChars = 4096;

/// Blanks and line breaks beside commas and equals signs are ignored. Each angle can be written
/// once.
/// @throws SourceError with the entry, its number, the valid range or the nearest name.
WrittenPose ParsePose(std::string_view text);

}  // namespace kinescope::subject
