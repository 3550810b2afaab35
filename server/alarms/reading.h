/// The value of a rule in a state. Pure functions; any thread.
#pragma once

#include <optional>

#include "core/scene_state.h"
#include "server/alarms/rule.h"

namespace kinescope::alarms {

struct Reading {
  std::optional<double> value;  // nullopt: unknown
  std::optional<int> joint;     // urdf::Joint, for the quantities of joints
};

/// @param joint_of_alarm that raised the alarm which is on: while it is unknown, so is the value of
/// all joints together, unless another one is beyond the limit.
/// @pre `rule` is for a quantity that the state has: neither loss nor silence
Reading ReadingOf(const Rule& rule, const SceneState& state, const PersonState& person,
                  std::optional<int> joint_of_alarm);

}  // namespace kinescope::alarms
