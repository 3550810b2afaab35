/// The choice of clock for the stamps of samples that come over the network (--stamps).
#pragma once

namespace kinescope::mvn {

/// Which clock gives BodySample::stamp_nanos.
enum class Stamps {
  kFitted,   // arrival smoothed onto the sender's clock (clock_fit.h)
  kArrival,  // as it came
};

}  // namespace kinescope::mvn
