/// How long a stretch of samples may be interrupted before it ends.
#pragma once

namespace kinescope::loads {

/// Seconds between two samples. After a longer gap speeds, contacts and classes start anew, and no
/// time is counted.
inline constexpr double kLongestGapSecs = 0.5;

}  // namespace kinescope::loads
