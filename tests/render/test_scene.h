/// Scenes for the tests of the renderer: the default body in a few poses, with loads of our choice.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>

#include "core/scene_state.h"
#include "render/camera/camera.h"

namespace kinescope::testing {

/// The joints that get a sphere, in the order of PersonState::loads.
extern const std::array<int, 15> kSphereJoints;

/// The default body; primitives for visuals.
std::shared_ptr<const PersonModel> MakePersonModel(std::uint64_t revision = 1);

enum class Posture { kStanding, kDeepBend, kArmsForward };

/// One live person at (x, y), facing +x, soles on the floor, every sphere of class `load_class`.
SceneState SceneWith(Posture posture, LoadClass load_class = LoadClass::kLow, double x = 0,
                     double y = 0);

/// The same with classes as a worker lifting something would have them: all of them occur.
SceneState MixedScene(Posture posture);

/// The same without loads, centre of mass and centre of pressure: the body alone.
SceneState BodyAlone(Posture posture = Posture::kStanding);

/// Sees all of it from the front.
render::Camera FrontCamera();

/// The load of `joint` in the first person; it must be there.
JointLoad& LoadOf(SceneState& state, int joint);

}  // namespace kinescope::testing
