/// Writes the skin of a person as a GLB (glTF 2.0): y up, metres; z is x of the world and x is its
/// y. In the bind pose, standing on the floor and facing z, or in the posture and at the place of
/// one moment. The skeleton's bones of segments have MVN's names; helper bones between them
/// (frame_names.h) carry what turns by part of a joint. Reading the file again (rigged_skin.h)
/// gives the same skin. Pure function, any thread.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "urdf/hand.h"
#include "urdf/kinematics.h"
#include "urdf/skin/person_skin.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::rig {

struct SkinPosture {
  urdf::LinkPoses links{};                            // world_from_link
  std::array<const urdf::FingerPoses*, 2> fingers{};  // of gloves, by urdf::Side
};

struct SkinGlbOptions {
  /// Shown by the nodes of the bones: vertices and bind matrices stay in the bind pose, which is
  /// moved to the person's pelvis, since viewers aim at it.
  std::optional<SkinPosture> posture;
  /// False: the surface as it is in the posture, for viewers that know no skinning.
  bool has_skeleton = true;
};

/// `colors`: of each triangle of `of`, the skin that the person has.
std::string WriteSkinGlb(const skin::PersonSkin& person, const skin::SkinTemplate& of,
                         const std::vector<skin::SkinTemplate::Color>& colors,
                         const SkinGlbOptions& options = {});

}  // namespace kinescope::rig
