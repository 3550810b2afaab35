/// The points that MVN knows on a body: joint centres and palpable bones, with MVN's names and
/// numbers (mvn-protocol.md 4.4). Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

struct Landmark {
  int segment = 0;                                       // urdf::Segment
  int number = 1;                                        // within the segment, from 1
  std::string name;                                      // "pTopOfHead"; a joint's begins with j
  Eigen::Vector3d in_segment = Eigen::Vector3d::Zero();  // from its origin, *segment* frame, m
  std::uint32_t flags = 0;  // as in type 13, where MVN does not explain them

  bool operator==(const Landmark& other) const {
    return segment == other.segment && number == other.number && name == other.name &&
           in_segment == other.in_segment && flags == other.flags;
  }
};

/// More than any MVN sends (127), and what one message of marker positions can hold.
inline constexpr std::size_t kMaxLandmarks = 255;

/// The offset of the landmark in its *link* frame, m; nullopt if there is none of that name.
std::optional<Eigen::Vector3d> FindLandmark(const Landmarks& landmarks, int segment,
                                            std::string_view name);

/// Number of the joint's centre among the points of its parent; in its child it is 1.
int PointNumberInParent(Joint joint);

/// The origin of the pelvis and both sides of every joint, by segment and number.
Landmarks JointLandmarksOf(const Skeleton& skeleton);

/// These and the ends of head, hands, heels and toes.
Landmarks LandmarksOf(const Skeleton& skeleton);

}  // namespace kinescope::urdf
