/// Rates that were measured with clocks that tremble. Pure functions.
#pragma once

#include <cmath>

namespace kinescope {

/// The whole number that `rate` is within 0.5 % of, from 1 on; else `rate`.
inline double NearWhole(double rate) {
  constexpr double kTremble = 0.005;
  const double whole = std::round(rate);
  return whole >= 1 && std::abs(rate - whole) <= kTremble * whole ? whole : rate;
}

}  // namespace kinescope
