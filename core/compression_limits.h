/// The limits of compression of the L5/S1 disc. Plain values, any thread.
#pragma once

#include <array>

namespace kinescope {

/// N: the action limit and the upper limit (NIOSH 1981; joint-loads.md 4.4).
inline constexpr std::array<double, 2> kCompressionLimits = {3400, 6400};

}  // namespace kinescope
