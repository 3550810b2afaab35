#include "core/person_links.h"

#include "core/system/check.h"

namespace kinescope {

std::vector<std::string> VisibleLinks(const urdf::HumanModel& human) {
  std::vector<std::string> names;
  names.reserve(urdf::kSegmentCount);
  for (int i = 0; i < urdf::kSegmentCount; ++i)
    names.push_back(urdf::LinkName(human.model_name, i));
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    for (int i = 0; human.gloves[side] && i < kFingersPerHand; ++i) {
      names.push_back(urdf::FingerLinkName(human.model_name, side, i));
    }
  }
  for (int i = 0; i < kMaxProps; ++i) {
    if (human.props.test(urdf::At(i))) names.push_back(urdf::PropLinkName(human.model_name, i));
  }
  return names;
}

bool IsOfBody(const urdf::HumanModel& human, std::size_t link, const urdf::Visual& visual) {
  std::size_t fingers = 0;
  for (const auto& glove : human.gloves) fingers += glove ? urdf::kFingersPerHand : 0;
  return link < urdf::kSegmentCount + fingers && visual.material != urdf::kToolMaterial;
}

std::vector<urdf::Pose> VisibleLinkPoses(const PersonState& person) {
  const urdf::HumanModel& human = person.model->human;
  std::vector<urdf::Pose> poses(person.links.begin(), person.links.end());
  for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
    if (!human.gloves[side]) continue;
    KINESCOPE_CHECK(person.gloves[side].has_value());
    const urdf::FingerPoses& links = person.gloves[side]->links;
    poses.insert(poses.end(), links.begin(), links.end());
  }
  for (std::size_t i = 0; i < kMaxProps; ++i) {
    if (!human.props.test(i)) continue;
    KINESCOPE_CHECK(person.props[i].has_value());
    poses.push_back(person.props[i]->pose);
  }
  return poses;
}

}  // namespace kinescope
