#pragma once

namespace kinescope::mvn {

/// Where a sample's time comes from.
enum class Stamps {
  kFitted,   // arrival smoothed onto the sender's clock (clock_fit.h)
  kArrival,  // as it came
};

}  // namespace kinescope::mvn
