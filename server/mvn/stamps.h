/// Defines which clock stamps the samples received over the network (option --stamps).
#pragma once

namespace kinescope::mvn {

/// Which clock gives BodySample::stamp_nanos.
enum class Stamps {
  kFitted,   // receive time, smoothed along the sender's clock (clock_fit.h)
  kArrival,  // receive time, unchanged
};

}  // namespace kinescope::mvn
