/// How much room a person takes in a picture. World, metres. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/scene_state.h"

namespace kinescope {

struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Balls whose common hull is around the person and what they hold.
std::vector<Ball> BallsOf(const PersonState& person);

/// A ball of the body, which moves with a link.
struct OutlinePoint {
  std::size_t link = 0;                                // index into VisibleLinkPoses()
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // in the link frame, m
  double radius = 0;
};

/// The same balls in any pose of the person, without loads in the hands.
std::vector<OutlinePoint> OutlineOf(const PersonModel& model);

}  // namespace kinescope
