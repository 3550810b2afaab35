/// Lists the visible links of a person in one order for all sinks: the 23 segments by
/// urdf::Segment, the twenty links of each gloved hand (right, then left), then the props. The link
/// of a gloved hand itself is in the list, too, but shows only a tool. Pure functions, any thread.
#pragma once

#include <string>
#include <vector>

#include "core/scene_state.h"

namespace kinescope {

/// Link names, as in the URDF.
std::vector<std::string> VisibleLinks(const urdf::HumanModel& human);

/// Whether the visual is a part of the body's surface, which a skin replaces; else it is held or
/// worn. `link`: its place in VisibleLinks(human).
bool IsOfBody(const urdf::HumanModel& human, std::size_t link, const urdf::Visual& visual);

/// world_from_link of each of VisibleLinks(person.model->human).
std::vector<urdf::Pose> VisibleLinkPoses(const PersonState& person);

}  // namespace kinescope
