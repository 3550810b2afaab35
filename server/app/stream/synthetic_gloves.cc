#include "server/app/stream/synthetic_gloves.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "core/system/check.h"
#include "server/mvn/encode.h"

namespace kinescope::app {
namespace {

constexpr double kGraspPeriodSecs = 4;
// How far each joint bends when the hand is closed, rad: knuckle, middle, end.
constexpr std::array<double, 3> kClosed = {1.1, 1.4, 0.8};
constexpr double kThumbClosed = 0.6;

// How far a finger's segment has turned against its parent when the hand is closed, rad; 0 for the
// bones of the palm.
double ClosedBy(int finger) {
  switch (urdf::KindOf(finger)) {
    case urdf::FingerJoint::kKnuckle:
    case urdf::FingerJoint::kMiddle:
    case urdf::FingerJoint::kEnd: break;
    default: return 0;
  }
  if (urdf::RayOf(finger) == 0) return kThumbClosed;
  return kClosed[urdf::At(urdf::PlaceInRay(finger) - 1)];
}

double HandLength(const Character& character, urdf::Side side) {
  static const urdf::Skeleton kDefault = urdf::DefaultSkeleton();
  return (character.skeleton ? *character.skeleton : kDefault).finger_tip_in_hand[side].norm();
}

// `seconds`: none for the open hand of the T-pose. Each finger bends a little later than the one
// before.
void AddHand(urdf::Side side, std::optional<double> seconds, const Character& character,
             BodySample& sample) {
  const urdf::HandSkeleton resting = urdf::DefaultHand(side, HandLength(character, side));
  const int segment = urdf::HandSegmentOf(side);
  const Eigen::Quaterniond& segment_from_link = urdf::SegmentFromLink(segment);
  const SegmentState& hand = sample.segments[urdf::At(segment)];
  std::array<urdf::Pose, kFingersPerHand> in_hand;  // segment frames
  for (int i = 0; i < kFingersPerHand; ++i) {
    urdf::Pose& pose = in_hand[urdf::At(i)];
    const int parent = kFingerParents[urdf::At(i)];
    if (parent >= 0) pose = in_hand[urdf::At(parent)];
    pose.position += pose.orientation * (segment_from_link * resting.origin_in_parent[urdf::At(i)]);
    if (!seconds || ClosedBy(i) == 0) continue;
    const double phase = 2 * M_PI * *seconds / kGraspPeriodSecs - 0.3 * urdf::RayOf(i);
    const double share = 0.5 - 0.5 * std::cos(phase);
    // About the axis that brings the finger down, to the palm; the thumb across it.
    Eigen::Vector3d towards(0, 0, -1);
    if (urdf::RayOf(i) == 0) towards += segment_from_link * Eigen::Vector3d(0, 0, -1);
    const Eigen::Vector3d along = segment_from_link * urdf::EndOf(resting, i);
    const Eigen::Vector3d axis = along.cross(towards).normalized();
    pose.orientation = pose.orientation * Eigen::AngleAxisd(share * ClosedBy(i), axis);
  }
  for (std::size_t i = 0; i < in_hand.size(); ++i) {
    const auto index = static_cast<std::size_t>(FingerIndex(side, static_cast<int>(i)));
    if (sample.fingers_and_props.present.test(index)) continue;
    sample.fingers_and_props.poses[index] = {hand.position + hand.orientation * in_hand[i].position,
                                             hand.orientation * in_hand[i].orientation};
    sample.fingers_and_props.present.set(index);
  }
}

// Where props are worn: the segment and the place in its frame, m.
struct PropMount {
  urdf::Segment segment;
  Eigen::Vector3d offset;
  const char* name;  // ends with the kind, as MVN's do
};
const std::array<PropMount, kMaxProps>& PropMounts() {
  static const std::array<PropMount, kMaxProps> kPropMounts = {{
      {urdf::kRightHand, {0, -0.08, -0.03}, "RightHandSword"},
      {urdf::kLeftHand, {0, 0.08, -0.03}, "LeftHandCrutch"},
      {urdf::kT8, {-0.15, 0, 0.05}, "BackGeneric"},
      {urdf::kPelvis, {0.05, 0.18, 0}, "HipGun"},
  }};
  return kPropMounts;
}

void AddAll(bool gloves, int props, std::optional<double> seconds, const Character& character,
            BodySample& sample) {
  KINESCOPE_CHECK(props >= 0 && props <= kMaxProps);
  for (int prop = 0; prop < props; ++prop) {
    const auto index = static_cast<std::size_t>(PropIndex(prop));
    if (sample.fingers_and_props.present.test(index)) continue;
    const PropMount& place = PropMounts()[static_cast<std::size_t>(prop)];
    const SegmentState& carrier = sample.segments[urdf::At(place.segment)];
    sample.fingers_and_props.poses[index] = {carrier.position + carrier.orientation * place.offset,
                                             carrier.orientation};
    sample.fingers_and_props.present.set(index);
  }
  if (!gloves) return;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    AddHand(side, seconds, character, sample);
  }
}

}  // namespace

void AddGlovesAndProps(bool gloves, int props, Character& character) {
  if (!character.skeleton || (!gloves && props == 0)) return;
  character.scaled_segments.resize(kFingerAndPropCount);
  // The T-pose is a sample like any other.
  BodySample t_pose;
  const auto origins = mvn::TPoseOrigins(*character.skeleton);
  for (std::size_t i = 0; i < origins.size(); ++i) t_pose.segments[i].position = origins[i];
  AddAll(gloves, props, std::nullopt, character, t_pose);
  for (std::size_t i = 0; i < character.scaled_segments.size(); ++i) {
    if (!t_pose.fingers_and_props.present.test(i) || !character.scaled_segments[i].name.empty())
      continue;
    character.scaled_segments[i] = {
        i < kMaxProps ? PropMounts()[i].name : FingerOrPropName(static_cast<int>(i)),
        t_pose.fingers_and_props.poses[i].position};
  }
}

void AddGlovesAndProps(bool gloves, int props, double seconds, const Character& character,
                       BodySample& sample) {
  AddAll(gloves, props, seconds, character, sample);
}

}  // namespace kinescope::app
