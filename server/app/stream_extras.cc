#include "server/app/stream_extras.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "server/core/check.h"
#include "server/mvn/encode.h"

namespace kinescope::app {
namespace {

// One ray of the hand: thumb to little finger, in lengths of the hand (wrist to tip of the middle
// finger), of an average adult. Frame of a right hand in the T-pose, mirrored for the left one:
// `forward` towards the thumb, `out` along the fingers.
struct Ray {
  double base_forward, base_out;        // where the metacarpal begins
  double knuckle_forward, knuckle_out;  // where it ends
  std::array<double, 3> phalanges;      // proximal, middle, distal; thumb: proximal, distal
};
constexpr std::array<Ray, 5> kRays = {{
    {0.11, 0.08, 0.27, 0.28, {0.18, 0.14, 0.0}},  // thumb
    {0.07, 0.12, 0.13, 0.49, {0.22, 0.13, 0.10}},
    {0.02, 0.13, 0.03, 0.50, {0.25, 0.15, 0.10}},
    {-0.03, 0.12, -0.06, 0.47, {0.23, 0.14, 0.10}},
    {-0.07, 0.11, -0.14, 0.42, {0.18, 0.10, 0.09}},
}};

constexpr double kGraspPeriodSecs = 4;
// How far each joint bends when the hand is closed, rad: knuckle, middle, end.
constexpr std::array<double, 3> kClosed = {1.1, 1.4, 0.8};
constexpr double kThumbClosed = 0.6;

// Where a finger's segment begins, in the frame of its hand in the T-pose, and where it points.
struct RestingSegment {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitY();  // of the ray, unit
  int bend = -1;                                         // index of kClosed; -1: a bone of the palm
  bool is_thumb = false;
};

std::array<RestingSegment, kFingersPerHand> RestingHand(urdf::Side side, double length) {
  const double out_sign = side == urdf::kRight ? -1 : 1;  // the right arm lies along -y
  const auto point = [&](double forward, double out) -> Eigen::Vector3d {
    return length * Eigen::Vector3d(forward, out_sign * out, 0);
  };
  std::array<RestingSegment, kFingersPerHand> segments;
  segments[0] = {Eigen::Vector3d::Zero(), point(0, 1).normalized()};  // the carpus, at the wrist
  std::size_t next = 1;
  for (std::size_t i = 0; i < kRays.size(); ++i) {
    const Ray& ray = kRays[i];
    const bool is_thumb = i == 0;
    const Eigen::Vector3d base = point(ray.base_forward, ray.base_out);
    Eigen::Vector3d at = point(ray.knuckle_forward, ray.knuckle_out);
    const Eigen::Vector3d direction = (at - base).normalized();
    segments[next++] = {base, direction, -1, is_thumb};
    const int phalanges = is_thumb ? 2 : 3;
    for (int k = 0; k < phalanges; ++k) {
      segments[next++] = {at, direction, k, is_thumb};
      at += direction * ray.phalanges[static_cast<std::size_t>(k)] * length;
    }
  }
  KINESCOPE_CHECK(next == segments.size());
  return segments;
}

double HandLength(const Character& character, urdf::Side side) {
  static const urdf::Skeleton kDefault = urdf::DefaultSkeleton();
  return (character.skeleton ? *character.skeleton : kDefault).finger_tip_in_hand[side].norm();
}

int HandOf(urdf::Side side) { return side == urdf::kRight ? urdf::kRightHand : urdf::kLeftHand; }

// `seconds`: none for the open hand of the T-pose. Each finger bends a little later than the one
// before.
void AddHand(urdf::Side side, std::optional<double> seconds, const Character& character,
             BodySample& sample) {
  const auto resting = RestingHand(side, HandLength(character, side));
  const SegmentState& hand = sample.segments[urdf::At(HandOf(side))];
  std::array<urdf::Pose, kFingersPerHand> in_hand;
  int ray = -1;
  for (std::size_t i = 0; i < resting.size(); ++i) {
    const RestingSegment& segment = resting[i];
    const int parent = kFingerParents[i];
    if (parent <= 0) ++ray;  // a carpus or metacarpal: the next ray
    urdf::Pose& pose = in_hand[i];
    if (parent >= 0) {
      const auto above = static_cast<std::size_t>(parent);
      pose.orientation = in_hand[above].orientation;
      pose.position =
          in_hand[above].position + pose.orientation * (segment.origin - resting[above].origin);
    }
    if (segment.bend < 0 || !seconds) continue;
    const double phase = 2 * M_PI * *seconds / kGraspPeriodSecs - 0.3 * ray;
    const double share = 0.5 - 0.5 * std::cos(phase);
    const double angle =
        share * (segment.is_thumb ? kThumbClosed : kClosed[static_cast<std::size_t>(segment.bend)]);
    // About the axis that brings the finger down, to the palm; the thumb across it.
    Eigen::Vector3d towards(0, 0, -1);
    if (segment.is_thumb) towards += resting[0].direction;
    const Eigen::Vector3d axis = segment.direction.cross(towards).normalized();
    pose.orientation = pose.orientation * Eigen::AngleAxisd(angle, axis);
  }
  for (std::size_t i = 0; i < in_hand.size(); ++i) {
    const auto index = static_cast<std::size_t>(FingerIndex(side, static_cast<int>(i)));
    if (sample.extra.present.test(index)) continue;
    sample.extra.poses[index] = {hand.position + hand.orientation * in_hand[i].position,
                                 hand.orientation * in_hand[i].orientation};
    sample.extra.present.set(index);
  }
}

// Where props are worn: the segment and the place in its frame, m.
struct Place {
  urdf::Segment segment;
  Eigen::Vector3d offset;
  const char* name;  // ends with the kind, as MVN's do
};
const std::array<Place, kMostProps>& Places() {
  static const std::array<Place, kMostProps> kPlaces = {{
      {urdf::kRightHand, {0, -0.08, -0.03}, "RightHandSword"},
      {urdf::kLeftHand, {0, 0.08, -0.03}, "LeftHandCrutch"},
      {urdf::kT8, {-0.15, 0, 0.05}, "BackGeneric"},
      {urdf::kPelvis, {0.05, 0.18, 0}, "HipGun"},
  }};
  return kPlaces;
}

void AddAll(bool gloves, int props, std::optional<double> seconds, const Character& character,
            BodySample& sample) {
  KINESCOPE_CHECK(props >= 0 && props <= kMostProps);
  for (int prop = 0; prop < props; ++prop) {
    const auto index = static_cast<std::size_t>(PropIndex(prop));
    if (sample.extra.present.test(index)) continue;
    const Place& place = Places()[static_cast<std::size_t>(prop)];
    const SegmentState& carrier = sample.segments[urdf::At(place.segment)];
    sample.extra.poses[index] = {carrier.position + carrier.orientation * place.offset,
                                 carrier.orientation};
    sample.extra.present.set(index);
  }
  if (!gloves) return;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    AddHand(side, seconds, character, sample);
  }
}

}  // namespace

void AddExtras(bool gloves, int props, Character& character) {
  if (!character.skeleton || (!gloves && props == 0)) return;
  character.extra.resize(kExtraCount);
  // The T-pose is a sample like any other.
  BodySample t_pose;
  const auto origins = mvn::TPoseOrigins(*character.skeleton);
  for (std::size_t i = 0; i < origins.size(); ++i) t_pose.segments[i].position = origins[i];
  AddAll(gloves, props, std::nullopt, character, t_pose);
  for (std::size_t i = 0; i < character.extra.size(); ++i) {
    if (!t_pose.extra.present.test(i) || !character.extra[i].name.empty()) continue;
    character.extra[i] = {i < kMostProps ? Places()[i].name : ExtraName(static_cast<int>(i)),
                          t_pose.extra.poses[i].position};
  }
}

void AddExtras(bool gloves, int props, double seconds, const Character& character,
               BodySample& sample) {
  AddAll(gloves, props, seconds, character, sample);
}

}  // namespace kinescope::app
