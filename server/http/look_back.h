/// Answers clients that look back: former states from the history. Server's thread only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "core/scene_state.h"
#include "server/history/history.h"
#include "server/http/protocol.h"

namespace kinescope::http {

// Limits of one answer, so that a client that asks for more does not delay others. It has at least
// one state.
inline constexpr std::size_t kMaxPastStates = 64;
inline constexpr std::size_t kMaxPastBytes = 256 << 10;  // no state is added beyond these
inline constexpr std::int64_t kMaxPastNanos = 5'000'000'000;

/// The text of the message "details" that belongs to `state`.
using DetailsOfState = std::function<std::string(const SceneState& state)>;

struct PastAnswer {
  Bytes message;
  std::size_t states = 0;
};

/// `most` states at most, in 1 to kMaxPastStates. Details change seldom, but cost more than their
/// state: of a run, they come with the first state, when people, objects or what is beside them are
/// others, and else with every sixteenth state if they differ. nullopt before the first state.
std::optional<PastAnswer> AnswerLookBack(const LookBack& wanted, std::size_t most,
                                         const history::History& history,
                                         const DetailsOfState& details, const StateMoment& moment);

}  // namespace kinescope::http
