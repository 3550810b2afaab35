/// Writes the skin of a person as a GLB (glTF 2.0) with its skeleton: in the bind pose, standing on
/// the floor, y up, facing z, metres. The bones of the segments have MVN's names; helper bones
/// between them (frame_names.h) carry what turns by part of a joint. Reading the file again
/// (rigged_skin.h) gives the same skin. Pure function, any thread.
#pragma once

#include <string>
#include <vector>

#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::rig {

/// `colors`: of each triangle of `of`, the skin that the person has.
std::string WriteSkinGlb(const skin::PersonSkin& person, const skin::SkinTemplate& of,
                         const std::vector<skin::SkinTemplate::Color>& colors);

}  // namespace kinescope::rig
