/// The links of a person that can be seen, in one order for all sinks: the 23 segments by
/// urdf::Segment, the twenty of the right hand and of the left where they are gloved, then the
/// props that are there. A gloved hand's own link is among them and shows nothing but a tool. Pure
/// functions, any thread.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope {

/// As in the URDF.
std::vector<std::string> VisibleLinks(const urdf::HumanModel& human);

/// world_from_link of each of VisibleLinks(person.model->human).
std::vector<urdf::Pose> VisibleLinkPoses(const PersonState& person);

}  // namespace kinescope
