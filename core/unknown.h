/// The number that stands for "not known" wherever a value is a plain double: NaN.
#pragma once

#include <limits>

namespace kinescope {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace kinescope
