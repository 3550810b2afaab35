/// Colours and sizes that carry meaning, the same in picture, RViz markers and page. sRGB, 0..1.
/// Source of the class colours: joint-loads.md 4.3 (the published ErgoLean scheme).
#pragma once

#include <array>

#include "server/core/scene_state.h"

namespace kinescope {

using Rgb = std::array<double, 3>;

/// Green, orange, red; grey for unknown.
Rgb ColorOf(LoadClass load_class);

inline constexpr Rgb kCopColor = {0.10, 0.35, 0.95};
inline constexpr Rgb kComColor = {0.55, 0.20, 0.75};
inline constexpr Rgb kBodyColor = {0.78, 0.80, 0.84};
inline constexpr Rgb kStaleBodyColor = {0.55, 0.55, 0.55};

/// Radius of the load sphere of `joint`, m: grows with the class, so that order reads without
/// colour. `height` is the person's stature.
double SphereRadius(int joint, LoadClass load_class, double height);

}  // namespace kinescope
