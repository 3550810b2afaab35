/// What several tests of the built-in subject need.
#pragma once

#include <algorithm>
#include <memory>
#include <string>

#include "server/subject/subject.h"
#include "urdf/kinematics.h"

namespace kinescope::subject::testing {

inline std::size_t Index(int i) { return static_cast<std::size_t>(i); }

/// The three points of a foot that can touch the floor, in the world.
struct FootPoints {
  Eigen::Vector3d heel, ball, tip;
  double lowest() const { return std::min({heel.z(), ball.z(), tip.z()}); }
};

inline FootPoints FootOf(const BodySample& sample, const urdf::Skeleton& skeleton,
                         urdf::Side side) {
  const urdf::LinkPoses links = LinkPosesOf(sample);
  const std::size_t foot = side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot;
  const auto at = [&](std::size_t link, const Eigen::Vector3d& in_link) -> Eigen::Vector3d {
    return links[link].position + links[link].orientation * in_link;
  };
  return {at(foot, skeleton.heel_in_foot[side]), links[foot + 1].position,
          at(foot + 1, skeleton.toe_tip_in_toe[side])};
}

}  // namespace kinescope::subject::testing
