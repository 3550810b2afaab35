/// The names of changes of people and limits in the log and in marks, for page and bridge. Any
/// thread.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "core/hand_load.h"
#include "core/person_change.h"
#include "core/scene_state.h"
#include "server/app/serve/operator_log.h"

namespace kinescope::app {

/// Null if `state` is null or has no such person.
const PersonState* FindPerson(const SceneState* state, int character);

/// As options and messages call a person.
std::string NameOf(const PersonState& person);
/// Of one who may be away.
std::string NameOf(const SceneState* state, int character);
/// Hand load that counts for a person of `state`; unknown where it has none. May be null.
HandLoad StatedHandLoadOf(const SceneState* state, int character);

/// "ros changed mass of Ben: 80 kg → 95 kg", a line for each. `stated`: what was changed before.
void NoteChange(OperatorLog& log, std::string_view role, const PersonState& person,
                const PersonChange& stated, const PersonChange& change);
void NoteClassLimits(OperatorLog& log, std::string_view role, const std::array<double, 2>& before,
                     const std::array<double, 2>& after);

}  // namespace kinescope::app
