#include "core/skin_inputs.h"

namespace kinescope {

skin::Build BuildOf(const PersonModel& model) {
  return skin::BuildOf(model.description.sex == urdf::Sex::kFemale, model.human.skeleton.height,
                       model.description.mass_kg);
}

std::array<const urdf::HandSkeleton*, 2> GlovesOf(const urdf::HumanModel& human) {
  std::array<const urdf::HandSkeleton*, 2> gloves{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (human.gloves[side]) gloves[side] = &*human.gloves[side];
  }
  return gloves;
}

std::array<const urdf::FingerPoses*, 2> FingersOf(const PersonState& person) {
  std::array<const urdf::FingerPoses*, 2> fingers{};
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (person.gloves[side]) fingers[side] = &person.gloves[side]->links;
  }
  return fingers;
}

}  // namespace kinescope
