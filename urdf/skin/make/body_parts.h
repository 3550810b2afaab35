/// The parts that body_solid.h joins: private to urdf/skin. Each is a signed function of a point in
/// the frame named, of the left side, m.
#pragma once

#include <array>

#include "urdf/skin/make/body_solid.h"
#include "urdf/skin/make/solid.h"

namespace kinescope::skin {

/// Joins solids one after another.
class Joined {
 public:
  explicit Joined(double first) : value_(first) {}
  /// `width`: how far the seam is rounded, m.
  void Add(double solid, double width) { value_ = SmoothMin(value_, solid, width); }
  /// Takes `solid` away.
  void Cut(double solid, double width) { value_ = SmoothMax(value_, -solid, width); }
  double value() const { return value_; }

 private:
  double value_;
};

/// In the frame of the bind pose. TrunkSolid holds the lofts, so make it once.
class TrunkSolid {
 public:
  explicit TrunkSolid(const Build& build);
  /// From the hips to the collar.
  double operator()(const Point& p) const;
  /// Shoulder girdle: trapezius, collar bone. @pre p.y() is of the side it is asked for.
  double Girdle(const Point& p) const;
  /// Of the trunk's width with `heavy` = 1, m, at this height.
  double Growth(const Point& p) const;

 private:
  Build build_;
  Loft loft_;
};

/// Link frame of the upper arm; the forearm is straight below it in the bind pose.
class ArmSolid {
 public:
  explicit ArmSolid(const Build& build);
  double operator()(const Point& q) const;

 private:
  Build build_;
  Loft loft_;
};

/// Link frame of the hand; `fingers`: in that frame too.
class HandSolid {
 public:
  HandSolid(const Build& build, const urdf::Pose& hand, const urdf::FingerPoses& fingers);
  double operator()(const Point& q) const;

 private:
  Build build_;
  Loft palm_;
  std::array<Point, urdf::kFingersPerHand> starts_, ends_;
};

/// Link frame of the thigh; the shank is straight below it in the bind pose.
class LegSolid {
 public:
  explicit LegSolid(const Build& build);
  double operator()(const Point& q) const;

 private:
  Build build_;
  Loft loft_;
};

/// Link frame of the foot: the sole is at z = -0.08.
double FootSolid(const Point& q, const Build& build);

/// Link frame of the head; y is mirrored to the left. Skull, face and ears.
double HeadSolid(const Point& q, const Build& build);
/// In the frame of the bind pose.
double NeckSolid(const Point& p, const Build& build);

}  // namespace kinescope::skin
