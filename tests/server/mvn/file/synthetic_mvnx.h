/// MVNX files of our own making, for tests that run without any recording.
#pragma once

#include <string>
#include <vector>

#include "core/body_sample.h"

namespace kinescope::mvn::testing {

/// A file of `samples`, indices from the first sample's counter, with every list that a sample has.
/// Version 3 writes the arms about their anatomical axes, as MVN Studio does. The calibration
/// frames of the version come first.
std::string WriteMvnx(int version, double rate_hz, const urdf::Skeleton& skeleton,
                      const std::vector<BodySample>& samples);

/// `count` samples of a default body that stands and swings its arms; joints meet exactly.
std::vector<BodySample> SwingingArms(const urdf::Skeleton& skeleton, int count);

}  // namespace kinescope::mvn::testing
