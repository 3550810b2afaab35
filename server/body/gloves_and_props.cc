#include "server/body/gloves_and_props.h"

namespace kinescope::app {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;
using urdf::Pose;

// nullopt unless scale data describe every segment of the hand, and bones that can be.
std::optional<urdf::HandSkeleton> DescribedHand(const Character& character, urdf::Side side,
                                                const Vector3d& carpus_in_hand, double length) {
  constexpr double kLongestBone = 0.2;  // m
  std::array<Vector3d, kFingersPerHand> origins;
  for (int i = 0; i < kFingersPerHand; ++i) {
    const std::size_t index = At(FingerIndex(side, i));
    if (index >= character.scaled_segments.size() || character.scaled_segments[index].name.empty())
      return std::nullopt;
    origins[At(i)] = character.scaled_segments[index].origin_in_world;
  }
  const urdf::HandSkeleton hand = urdf::HandFromTPose(side, origins, carpus_in_hand, length);
  for (const Vector3d& bone : hand.origin_in_parent) {
    if (!(bone.norm() <= kLongestBone)) return std::nullopt;
  }
  return hand;
}

}  // namespace

bool GlovesAndProps::Notice(const BodySample& sample) {
  bool is_more = false;
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const std::size_t carpus = At(FingerIndex(side, 0));
    if (carpus_in_hand_[side] || !sample.fingers_and_props.present.test(carpus)) continue;
    // Scale data have the T-pose of the fingers, but a Character not their hand's place in it.
    const Pose world_from_hand = LinkPoseOf(sample, urdf::HandSegmentOf(side));
    constexpr double kReach = 0.1;  // m; farther off is no part of this hand
    const Vector3d offset =
        Relative(world_from_hand, sample.fingers_and_props.poses[carpus]).position;
    carpus_in_hand_[side].emplace(Vector3d::Zero());
    if (offset.norm() <= kReach) *carpus_in_hand_[side] = offset;
    is_more = true;
  }
  for (std::size_t prop = 0; prop < kMaxProps; ++prop) {
    const std::size_t index = At(PropIndex(static_cast<int>(prop)));
    if (props_.test(prop) || !sample.fingers_and_props.present.test(index)) continue;
    props_.set(prop);
    is_more = true;
  }
  return is_more;
}

void GlovesAndProps::AddTo(const Character& character, urdf::HumanModel& human) const {
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    const auto& carpus = carpus_in_hand_[side];
    if (!carpus) continue;
    const double length = human.skeleton.finger_tip_in_hand[side].norm();
    human.gloves[side] = DescribedHand(character, side, *carpus, length);
    if (human.gloves[side]) continue;
    human.gloves[side] = urdf::DefaultHand(side, length);
    human.gloves[side]->origin_in_parent[0] = *carpus;
  }
  human.props = props_;
}

void GlovesAndProps::Follow(const BodySample& sample, PersonState& state) {
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (state.model->human.gloves[side]) state.gloves[side] = FollowGlove(side, sample, state);
  }
  for (std::size_t prop = 0; prop < kMaxProps; ++prop) {
    if (!state.model->human.props.test(prop)) continue;
    state.props[prop] = FollowProp(prop, sample, state.links[urdf::kPelvis]);
  }
}

GloveState GlovesAndProps::FollowGlove(urdf::Side side, const BodySample& sample,
                                       const PersonState& state) {
  const int hand = urdf::HandSegmentOf(side);
  std::bitset<kFingersPerHand> present;
  urdf::FingerPoses measured;
  for (int i = 0; i < kFingersPerHand; ++i) {
    const std::size_t index = At(FingerIndex(side, i));
    present.set(At(i), sample.fingers_and_props.present.test(index));
    const Pose& segment = sample.fingers_and_props.poses[index];
    measured[At(i)] = {segment.position, segment.orientation * urdf::SegmentFromLink(hand)};
  }
  GloveState glove;
  glove.links = urdf::CompleteHand(*state.model->human.gloves[side], state.links[At(hand)],
                                   measured, present, finger_angles_[side]);
  glove.angles = finger_angles_[side];
  return glove;
}

PropState GlovesAndProps::FollowProp(std::size_t prop, const BodySample& sample,
                                     const Pose& pelvis) {
  const std::size_t index = At(PropIndex(static_cast<int>(prop)));
  Pose& in_pelvis = pelvis_from_prop_[prop];
  if (sample.fingers_and_props.present.test(index))
    in_pelvis = Relative(pelvis, sample.fingers_and_props.poses[index]);
  prop_angles_[prop] = urdf::AnglesFromRotation(in_pelvis.orientation, prop_angles_[prop]);
  PropState state;
  state.pose = {pelvis.position + pelvis.orientation * in_pelvis.position,
                pelvis.orientation * in_pelvis.orientation};
  state.angles = prop_angles_[prop];
  return state;
}

}  // namespace kinescope::app
