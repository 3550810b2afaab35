/// What a person wears and holds, gloves and props, from sample to sample: once seen they belong to
/// the person's model and stay. Plain value; one thread.
#pragma once

#include <array>
#include <bitset>
#include <optional>

#include "core/scene_state.h"

namespace kinescope::app {

class WornExtras {
 public:
  /// True when `sample` has gloves or props that were not seen before: the model must be made anew.
  [[nodiscard]] bool Notice(const BodySample& sample);

  /// Adds what was seen. Hands have the lengths of the scale data in `character`, where those have
  /// all of it, else an average hand's. @pre `human` has its skeleton
  void AddTo(const Character& character, urdf::HumanModel& human) const;

  /// Where they are in `sample`, into `state`; what the sample lacks stays as it was against hand
  /// and pelvis. @pre `state` has its model, from AddTo, and its links
  void Follow(const BodySample& sample, PersonState& state);

 private:
  GloveState FollowGlove(urdf::Side side, const BodySample& sample, const PersonState& state);
  PropState FollowProp(std::size_t prop, const BodySample& sample, const urdf::Pose& pelvis);

  std::array<std::optional<Eigen::Vector3d>, 2> carpus_in_hand_;  // link frames, by urdf::Side
  std::array<urdf::FingerAngles, 2> finger_angles_{};             // likewise
  std::bitset<kMostProps> props_;
  std::array<urdf::Pose, kMostProps> pelvis_from_prop_{};
  std::array<Eigen::Vector3d, kMostProps> prop_angles_{};
};

}  // namespace kinescope::app
