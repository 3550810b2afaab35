/// Defines the longest gap between samples that does not end a continuous motion.
#pragma once

namespace kinescope::loads {

/// Seconds between two samples. After a longer gap, speeds, contacts and classes start over, and
/// the time is not counted.
inline constexpr double kLongestGapSecs = 0.5;

}  // namespace kinescope::loads
