/// The class of a joint load: how much of its capacity a joint uses. Plain values, any thread.
#pragma once

#include <array>
#include <cstddef>

namespace kinescope {

enum class LoadClass { kUnknown = 0, kLow = 1, kMedium = 2, kHigh = 3 };

inline constexpr std::size_t kLoadClassCount = 4;

/// In the order of their values, which are indices of arrays by class.
inline constexpr std::array<LoadClass, kLoadClassCount> kLoadClasses = {
    LoadClass::kUnknown, LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh};

/// In the order of legends and tables: by rising load, unknown last.
inline constexpr std::array<LoadClass, kLoadClassCount> kLoadClassesOfTables = {
    LoadClass::kLow, LoadClass::kMedium, LoadClass::kHigh, LoadClass::kUnknown};

/// Ratios of capacity. While the ratio rises, a load above the first is medium, above the second
/// high.
inline constexpr std::array<double, 2> kDefaultClassLimits = {0.30, 0.60};
/// While it falls, a load keeps its class until it is below these.
inline constexpr std::array<double, 2> kDefaultClassFallsBelow = {0.25, 0.55};

/// "unknown", "low", "medium", "high".
const char* Name(LoadClass load_class);

}  // namespace kinescope
