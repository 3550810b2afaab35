#include "urdf/hand_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "urdf/loft.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

// All measures below are those of a hand of this length; others are in proportion.
constexpr double kReferenceLength = 0.19;
constexpr double kShortestBone = 1e-3;  // m; scale data may have bones of no length

double ScaleOf(const HandSkeleton& hand) {
  // Whatever a stream claims, a hand is between a toddler's and a giant's.
  return std::clamp(hand.length, 0.05, 0.4) / kReferenceLength;
}

// At the knuckle, m; thumb to little finger.
constexpr std::array<double, 5> kKnuckleRadius = {.0128, .0099, .0102, .0098, .0087};
// Where a segment begins, in radii of the knuckle, from metacarpal to end; then the fingertip.
constexpr std::array<double, 5> kTaper = {0.90, 1.00, 0.95, 0.88, 0.76};
constexpr std::array<double, 4> kThumbTaper = {1.10, 1.00, 0.90, 0.74};
constexpr double kSlimmer = 0.95;  // halfway between two joints

struct Radii {
  double start, end;  // m
};

Radii RadiiOf(const HandSkeleton& hand, int finger) {
  const double knuckle = ScaleOf(hand) * kKnuckleRadius[At(RayOf(finger))];
  const std::size_t place = At(PlaceInRay(finger));
  if (RayOf(finger) == 0) return {knuckle * kThumbTaper[place], knuckle * kThumbTaper[place + 1]};
  return {knuckle * kTaper[place], knuckle * kTaper[place + 1]};
}

// From the segment's origin to the middle of the ball at its end: a fingertip's ball ends where the
// finger does.
Vector3d BoneOf(const HandSkeleton& hand, int finger) {
  Vector3d bone = EndOf(hand, finger);
  const double length = bone.norm();
  if (length < kShortestBone) return {0, 0, -kShortestBone};
  if (!IsFingertip(finger)) return bone;
  return bone * std::max(1 - RadiiOf(hand, finger).end / length, 0.3);
}

// Where the palm is in the link frame of the carpus while every joint of the palm is straight.
struct Palm {
  Vector3d wrist, knuckles;                // of the hand; the middle of the four
  Vector3d to_thumb;                       // across, unit
  double thumb_side = 0, little_side = 0;  // how far it reaches across at the knuckles, m
  Vector3d along() const { return knuckles - wrist; }
};

Palm PalmOf(const HandSkeleton& hand) {
  std::array<Vector3d, 4> knuckles;
  Palm palm;
  for (std::size_t i = 0; i < knuckles.size(); ++i) {
    const int metacarpal = MetacarpalOf(static_cast<int>(i) + 1);
    knuckles[i] = hand.origin_in_parent[At(metacarpal)] + hand.origin_in_parent[At(metacarpal) + 1];
    palm.knuckles += knuckles[i] / 4;
  }
  palm.wrist = -hand.origin_in_parent[0];  // a carpus that is not there is drawn out to it
  if (palm.along().norm() < kShortestBone)
    palm.knuckles = palm.wrist - kShortestBone * Vector3d::UnitZ();
  const Vector3d along = palm.along().normalized();
  const Vector3d across = knuckles.front() - knuckles.back();
  palm.to_thumb = across - along * along.dot(across);
  if (palm.to_thumb.norm() < kShortestBone) palm.to_thumb = along.unitOrthogonal();
  palm.to_thumb.normalize();
  for (std::size_t i = 0; i < knuckles.size(); ++i) {
    const double radius = 1.15 * ScaleOf(hand) * kKnuckleRadius[i + 1];
    const double at = palm.to_thumb.dot(knuckles[i] - palm.knuckles);
    palm.thumb_side = std::max(palm.thumb_side, at + radius);
    palm.little_side = std::max(palm.little_side, radius - at);
  }
  return palm;
}

TriangleMesh PalmMesh(const HandSkeleton& hand) {
  const Palm palm = PalmOf(hand);
  const double scale = ScaleOf(hand);
  // Half, m: a little more than the forearm's end has, so that the glove begins in a clean line
  // around it, however the wrist bends.
  constexpr double kWristWidth = .0305, kWristThickness = .0240;
  // `open`: 0 as wide as the wrist, 1 as the knuckles.
  const auto section = [&](double at, double open, double thickness, double power) {
    const double wrist = scale * kWristWidth;
    const double thumb = wrist + open * (palm.thumb_side - wrist);
    const double little = wrist + open * (palm.little_side - wrist);
    return Widths(at, thumb, little, scale * thickness, scale * thickness).Power(power, power);
  };
  const Profile profile({section(0, 0, kWristThickness, 2), section(0.28, 0.35, .0182, 2.3),
                         section(0.66, 0.98, .0160, 2.4), section(1, 0.80, .0122, 2.2)});
  LoftRange range;
  range.start_cap = scale * kWristThickness;
  range.end_cap = scale * .016;
  range.points = 18;
  range.rings = 7;
  range.start_rings = range.end_rings = 4;
  TriangleMesh mesh;
  AddLoft({Curve({palm.wrist, palm.knuckles}), palm.to_thumb,
           palm.to_thumb.cross(palm.along().normalized()), 1},
          profile, range, mesh);
  return mesh;
}

Primitive PalmBox(const HandSkeleton& hand) {
  const Palm palm = PalmOf(hand);
  const Vector3d z = palm.along().normalized();
  Eigen::Matrix3d axes;
  axes << palm.to_thumb, z.cross(palm.to_thumb), z;
  Primitive box;
  box.size = {palm.thumb_side + palm.little_side, 2 * .016 * ScaleOf(hand), palm.along().norm()};
  box.center = 0.5 * (palm.wrist + palm.knuckles) +
               0.5 * (palm.thumb_side - palm.little_side) * palm.to_thumb;
  // Fixed-axis roll, pitch, yaw are turns about the moved axes in the opposite order.
  const Vector3d yaw_pitch_roll = axes.eulerAngles(2, 1, 0);
  box.rpy = yaw_pitch_roll.reverse();
  return box;
}

}  // namespace

TriangleMesh FingerMesh(const HandSkeleton& hand, int finger) {
  if (finger == 0) return PalmMesh(hand);
  const Radii radii = RadiiOf(hand, finger);
  const auto round = [](double at, double radius) {
    return Widths(at, radius, radius, radius, radius);
  };
  const Profile profile({round(0, radii.start),
                         round(0.5, 0.5 * kSlimmer * (radii.start + radii.end)),
                         round(1, radii.end)});
  LoftRange range;
  range.start_cap = radii.start;
  range.end_cap = radii.end;
  range.points = 12;
  range.rings = 4;
  range.start_rings = range.end_rings = 3;
  const Vector3d bone = BoneOf(hand, finger);
  const Vector3d u = bone.unitOrthogonal();
  TriangleMesh mesh;
  AddLoft({Curve({Vector3d::Zero(), bone}), u, u.cross(bone.normalized()), 1}, profile, range,
          mesh);
  return mesh;
}

std::vector<Primitive> FingerPrimitives(const HandSkeleton& hand, int finger) {
  if (finger == 0) return {PalmBox(hand)};
  const Radii radii = RadiiOf(hand, finger);
  const Vector3d bone = BoneOf(hand, finger);
  const Vector3d unit = bone.normalized();
  Primitive rod;
  rod.kind = Primitive::Kind::kCylinder;
  rod.size = {0.5 * (radii.start + radii.end), bone.norm(), 0};
  rod.center = 0.5 * bone;
  // Turns z onto the bone: first about x, then about y.
  rod.rpy = {std::asin(-unit.y()), std::atan2(unit.x(), unit.z()), 0};
  const auto ball = [](const Vector3d& center, double radius) {
    return Primitive{Primitive::Kind::kSphere, {radius, 0, 0}, center, Vector3d::Zero()};
  };
  return {rod, ball(Vector3d::Zero(), radii.start), ball(bone, radii.end)};
}

Primitive PalmBoxInHand(const HandSkeleton& hand) {
  Primitive box = PalmBox(hand);
  box.center += hand.origin_in_parent[0];
  return box;
}

}  // namespace kinescope::urdf
