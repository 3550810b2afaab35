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

/// What a live view of people shows.
struct ViewRoom {
  double height = 0;  // of the picture, m
  double below = 0;   // m, by which what comes towards the camera seems to be below the floor
};

/// What a live view shows so that the person fills most of it, whichever side it is seen from: up
/// to their highest part above the floor, or as wide as they reach to a side; its height within
/// what is sensible, 0.9 to 3.4 m.
ViewRoom RoomFor(const PersonState& person, double floor_z);

/// Share of that height that the person fills.
inline constexpr double kLiveFill = 0.74;

}  // namespace kinescope
