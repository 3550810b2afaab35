/// What the skin of a person (urdf/skin) needs to know of them. Pure functions, any thread.
#pragma once

#include <array>

#include "core/scene_state.h"
#include "urdf/hand.h"
#include "urdf/human_urdf.h"
#include "urdf/skin/skin_template.h"

namespace kinescope {

skin::Build BuildOf(const PersonModel& model);

/// By urdf::Side; null: no glove. They point into the argument.
std::array<const urdf::HandSkeleton*, 2> GlovesOf(const urdf::HumanModel& human);
std::array<const urdf::FingerPoses*, 2> FingersOf(const PersonState& person);

}  // namespace kinescope
