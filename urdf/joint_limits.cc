#include "urdf/joint_limits.h"

#include <array>
#include <cmath>

namespace kinescope::urdf {
namespace {

struct Axis {
  double low, high;  // degrees
  double effort;     // N m
  double velocity;   // rad/s
};
using Axes = std::array<Axis, 3>;  // x, y, z

// Right side, in the axes of its links: forward flexion of arm and hip and bending of the elbow are
// negative about y.
//
// Ranges: normal active motion (joint_limits.h has the sources), some 10 degrees wider. Cardan
// angles about three axes are not those of a goniometer: where a joint reaches the singularity
// (x = 90 degrees) the other two may be anything, so the shoulder has the whole turn. So has the
// elbow: MVN can misjudge how far the upper arm is turned about itself and then has the forearm
// bend sideways (x to -86 degrees, by its own angles too, in a recording of a singer).
//
// Efforts: the strongest 5 % of men where known, else twice the male median (joint-loads.md 4.2).
// An axis that no muscle turns is held by ligaments and has the strength of the strongest.
//
// Velocities: above the fastest seen in sport: throwing (upper arm inwards 7700 deg/s, elbow 2300
// deg/s), kicking and sprinting (knee 1700 deg/s).
constexpr std::array<Axes, kJointGroupCount> kBodyAxes = {{
    {{{-25, 25, 261, 10}, {-25, 45, 503, 10}, {-25, 25, 140, 15}}},         // spine
    {{{-50, 50, 64, 15}, {-60, 60, 102, 15}, {-80, 80, 26, 20}}},           // neck
    {{{-50, 30, 180, 10}, {-35, 35, 180, 10}, {-40, 40, 180, 10}}},         // clavicle
    {{{-200, 200, 180, 40}, {-200, 200, 180, 40}, {-200, 200, 104, 140}}},  // shoulder
    {{{-120, 120, 111, 50}, {-200, 200, 111, 50}, {-200, 200, 111, 60}}},   // elbow
    {{{-100, 100, 24, 60}, {-55, 55, 22, 60}, {-45, 45, 24, 60}}},          // wrist
    {{{-90, 60, 194, 20}, {-150, 50, 342, 20}, {-80, 80, 120, 25}}},        // hip
    {{{-25, 25, 318, 35}, {-20, 170, 318, 35}, {-50, 50, 318, 35}}},        // knee
    {{{-50, 50, 60, 30}, {-50, 75, 237, 30}, {-50, 50, 60, 30}}},           // ankle
    {{{-25, 25, 60, 30}, {-90, 55, 60, 30}, {-25, 25, 60, 30}}},            // ball of the foot
}};

// Fingers: ranges as above; bent about +x on the right. Efforts from the strongest grip, some 120 N
// at a finger's tip.
constexpr Axes kCarpusAxes = {{{-30, 30, 24, 60}, {-30, 30, 24, 60}, {-30, 30, 24, 60}}};
constexpr Axes kPalmAxes = {{{-30, 45, 10, 60}, {-30, 30, 10, 60}, {-30, 30, 10, 60}}};
constexpr Axes kThumbBaseAxes = {{{-80, 80, 10, 60}, {-80, 80, 10, 60}, {-80, 80, 10, 60}}};
constexpr Axes kKnuckleAxes = {{{-55, 105, 10, 60}, {-40, 40, 10, 60}, {-40, 40, 10, 60}}};
constexpr Axes kMiddleAxes = {{{-25, 125, 6, 60}, {-30, 30, 6, 60}, {-30, 30, 6, 60}}};
constexpr Axes kEndAxes = {{{-35, 105, 3, 60}, {-30, 30, 3, 60}, {-30, 30, 3, 60}}};

const Axes& AxesOf(FingerJoint joint) {
  switch (joint) {
    case FingerJoint::kCarpus: return kCarpusAxes;
    case FingerJoint::kPalm: return kPalmAxes;
    case FingerJoint::kThumbBase: return kThumbBaseAxes;
    case FingerJoint::kKnuckle: return kKnuckleAxes;
    case FingerJoint::kMiddle: return kMiddleAxes;
    case FingerJoint::kEnd: break;
  }
  return kEndAxes;
}

AxisLimit ToLimit(const Axis& right, bool is_left, int axis) {
  const double to_rad = M_PI / 180;
  AxisLimit limit{right.low * to_rad, right.high * to_rad, right.effort, right.velocity};
  if (is_left && axis != 1) {  // mirrored in the sagittal plane
    limit.lower = -right.high * to_rad;
    limit.upper = -right.low * to_rad;
  }
  return limit;
}

}  // namespace

AxisLimit LimitOf(int joint, int axis) {
  const Axes& axes = kBodyAxes[At(JointGroupOf(joint))];
  return ToLimit(axes[At(axis)], IsLeftJoint(joint), axis);
}

AxisLimit LimitOf(FingerJoint joint, bool is_left, int axis) {
  return ToLimit(AxesOf(joint)[At(axis)], is_left, axis);
}

}  // namespace kinescope::urdf
