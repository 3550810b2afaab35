/// Defines the colours and sizes that carry meaning, identical in pictures, RViz markers and the
/// page. sRGB, 0..1. Source of the hues of the load classes: joint-loads.md 4.3 (the published
/// ErgoLean scheme). Their shades are chosen so that any two of the four stay distinguishable
/// (CIEDE2000 >= 15), also for people without red, green or blue cones:
/// tests/render/color_vision_test.cc simulates them. Pure functions and constants, any thread.
#pragma once

#include <array>

#include "core/scene_state.h"
#include "core/suit_colors.h"

namespace kinescope {

/// Low: bluish green; medium: orange; high: dark red; unknown: slate grey.
Rgb ColorOf(LoadClass load_class);

inline constexpr Rgb kCopColor = {0.10, 0.35, 0.95};
inline constexpr Rgb kComColor = {0.55, 0.20, 0.75};
inline constexpr Rgb kSupportColor = {0.36, 0.49, 0.71};
/// Length of the arrow of a ground reaction force: 1 m for 1000 N.
inline constexpr double kMetresPerNewton = 1e-3;
inline constexpr double kMinForceShown = 20;  // N; below it the arrow is a dot
inline constexpr Rgb kBodyColor = {0.78, 0.80, 0.84};
inline constexpr Rgb kClayColor = {0.72, 0.69, 0.65};  // of --style clay
/// Of reference poses: cool, apart from the floor, and no colour of a person or a class. They are
/// mixed with the colours of the body.
inline constexpr Rgb kGhostOnLight = {0.35, 0.45, 0.62}, kGhostOnDark = {0.60, 0.72, 0.92};
inline constexpr double kGhostShare = 0.75;
inline constexpr Rgb kStaleBodyColor = {0.55, 0.55, 0.55};
inline constexpr Rgb kObjectColor = {0.42, 0.46, 0.54};  // tracked objects and props
/// Of the x, y and z axis of a frame: the hues of RViz, paler than any load class.
inline constexpr std::array<Rgb, 3> kAxisColors = {
    {{0.86, 0.42, 0.42}, {0.44, 0.72, 0.44}, {0.42, 0.50, 0.86}}};

/// How large the mark of a class is, as a share of that of the class high; each is at least 15 %
/// larger than the one below, so that the order is visible without colour. Unknown is the smallest.
double SizeOf(LoadClass load_class);

/// The rim of the mark of a class: above 0 dark, below 0 white, the value is its opacity; 0: none.
double RimOf(LoadClass load_class);

/// Radius of the load sphere of `joint`, m: no sphere is wider than the person's limb around it at
/// rest, by their sex, stature and mass.
double SphereRadius(int joint, LoadClass load_class, const PersonModel& model);

/// How far before its joint a load sphere counts as being, m: it is drawn over the skin around it,
/// and is hidden by other limbs. `height`: stature of the person, m.
double SphereDepth(int joint, double height);

/// Of the marks of a person, m.
struct MarkSizes {
  double com, com_depth;  // the sphere of the CoM: radius, and depth as of a load sphere
  double com_ring;        // outer radius of the ring on the floor below it
  double com_line;        // radius of the line between them
  double cop_edge, cop;   // radii of the disc of the CoP with and without its white edge
};
/// `height`: stature of the person, m.
MarkSizes MarkSizesOf(double height);
inline constexpr double kComRingHole = 0.78;    // its radius, as a share of the ring's
inline constexpr double kSupportWidth = 0.006;  // m, of the lines of the support polygon

}  // namespace kinescope
