/// What bones are called in rigs that follow no standard. Pure function, any thread.
#pragma once

#include <string>

namespace kinescope::rig {

/// The VRM name, in lower case, of a bone that is named as Blender (`DEF-upper_arm.L`), 3ds Max
/// (`Bip01 L UpperArm`), Unreal (`upperarm_l`) or Character Creator (`CC_Base_L_Upperarm`) name it,
/// or by its joint (`B_Knee_Left`); "": none of the body's. Helpers, such as twist bones, have
/// none.
std::string UsualName(const std::string& name);

}  // namespace kinescope::rig
