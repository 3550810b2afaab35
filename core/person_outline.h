/// How much room a person takes in a picture. World, metres. Pure functions, any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/scene_state.h"

namespace kinescope {

struct Ball {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Balls whose common hull is around the person and what they hold.
std::vector<Ball> BallsOf(const PersonState& person);

/// Height that a live view shows so that the person fills most of it: their highest part above the
/// floor, or twice how far they reach to a side; within what is sensible, 0.9 to 3.4 m.
double HeightFor(const PersonState& person, double floor_z);

/// Share of that height that the person fills.
inline constexpr double kLiveFill = 0.72;

}  // namespace kinescope
