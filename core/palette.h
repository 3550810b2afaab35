/// Colours and sizes that carry meaning, the same in picture, RViz markers and page. sRGB, 0..1.
/// Source of the classes' hues: joint-loads.md 4.3 (the published ErgoLean scheme). Their shades
/// are chosen so that any two of the four stay apart (CIEDE2000 >= 15) for people without red,
/// green or blue cones too: tests/render/color_vision_test.cc simulates them.
#pragma once

#include <array>

#include "core/scene_state.h"

namespace kinescope {

using Rgb = std::array<double, 3>;

/// A bluish green, orange, a dark red; slate grey for unknown.
Rgb ColorOf(LoadClass load_class);

inline constexpr Rgb kCopColor = {0.10, 0.35, 0.95};
inline constexpr Rgb kComColor = {0.55, 0.20, 0.75};
inline constexpr Rgb kSupportColor = {0.36, 0.49, 0.71};
/// Of the floor's force on a foot, as an arrow: 1 m for 1000 N.
inline constexpr double kMetresPerNewton = 1e-3;
inline constexpr double kLeastForceShown = 20;  // N; shorter arrows are dots
inline constexpr Rgb kBodyColor = {0.78, 0.80, 0.84};
inline constexpr Rgb kStaleBodyColor = {0.55, 0.55, 0.55};
inline constexpr Rgb kObjectColor = {0.42, 0.46, 0.54};  // of a tracked object; props have it too
/// Of the x, y and z axis of its frame, as RViz has them, and paler than any class.
inline constexpr std::array<Rgb, 3> kAxisColors = {
    {{0.86, 0.42, 0.42}, {0.44, 0.72, 0.44}, {0.42, 0.50, 0.86}}};

/// Radius of the load sphere of `joint`, m: grows with the class, so that order reads without
/// colour. `height` is the person's stature.
double SphereRadius(int joint, LoadClass load_class, double height);

}  // namespace kinescope
