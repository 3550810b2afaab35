/// Tracks a person's gloves and props from sample to sample: once seen, they are part of the
/// person's model and stay. Plain value; one thread.
#pragma once

#include <array>
#include <bitset>
#include <optional>

#include "core/scene_state.h"

namespace kinescope::app {

class GlovesAndProps {
 public:
  /// True if `sample` has gloves or props that were not seen before: the model must then be
  /// rebuilt.
  [[nodiscard]] bool Notice(const BodySample& sample);

  /// Adds the gloves and props that were seen. Hands have the lengths of the scale data in
  /// `character` if these are complete, else those of an average hand. @pre `human` has its
  /// skeleton
  void AddTo(const Character& character, urdf::HumanModel& human) const;

  /// Writes the poses in `sample` of those in the model to `state`; parts that the sample lacks
  /// keep their pose relative to hand or pelvis. @pre `state` has its model, from AddTo now or
  /// earlier, and its links
  void Follow(const BodySample& sample, PersonState& state);

 private:
  GloveState FollowGlove(urdf::Side side, const BodySample& sample, const PersonState& state);
  PropState FollowProp(std::size_t prop, const BodySample& sample, const urdf::Pose& pelvis);

  std::array<std::optional<Eigen::Vector3d>, 2> carpus_in_hand_;  // m, link frames, by urdf::Side
  std::array<urdf::FingerAngles, 2> finger_angles_{};             // rad, by urdf::Side
  std::bitset<kMaxProps> props_;
  std::array<urdf::Pose, kMaxProps> pelvis_from_prop_{};
  std::array<Eigen::Vector3d, kMaxProps> prop_angles_{};
};

}  // namespace kinescope::app
