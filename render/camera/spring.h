/// Carries a value over to another: a critically damped spring, which neither jerks nor overshoots.
/// Pure function, any thread.
#pragma once

#include <cmath>

namespace kinescope::render {

/// The exact motion during `dt`, so that the number of pictures does not matter.
/// @param value,speed  of now; those after `dt` replace them
/// @param stiffness    1/s; half of the way takes 1.7 / stiffness
/// @param dt           s
inline void Glide(double& value, double& speed, double to, double stiffness, double dt) {
  const double decay = std::exp(-stiffness * dt);
  const double away = value - to, pull = speed + stiffness * away;
  value = to + decay * (away + dt * pull);
  speed = decay * (speed - stiffness * dt * pull);
}

}  // namespace kinescope::render
