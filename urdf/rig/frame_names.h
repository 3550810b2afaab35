/// Names of the frames of a skin as bones of a GLB: those of the segments are MVN's, the others are
/// helpers between them ("RightForeArm_swing2", "LeftHand_ThirdPP_half"). Pure functions, any
/// thread.
#pragma once

#include <string>

namespace kinescope::rig {

/// @pre 0 <= frame < skin::Frames().size()
std::string NameOfFrame(int frame);
/// The helper frame with this name; -1: none.
int FrameNamed(const std::string& name);

}  // namespace kinescope::rig
