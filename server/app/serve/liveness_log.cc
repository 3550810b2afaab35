#include "server/app/serve/liveness_log.h"

#include <spdlog/spdlog.h>

#include <string>

namespace kinescope::app {
namespace {

std::string FirstPersonIn(const SceneState& state) {
  if (state.people.empty() || state.people.front().name.empty()) return "a person";
  return "'" + state.people.front().name + "'";
}

}  // namespace

void LivenessLog::OnState(const SceneState& state) {
  if (logged_ == state.liveness) return;
  logged_ = state.liveness;
  switch (state.liveness) {
    case Liveness::kNoData: spdlog::info("waiting for data from {}", state.source); break;
    case Liveness::kNoPerson:
      spdlog::info("no person in {} now: what else is there is shown", state.source);
      break;
    case Liveness::kLive:
      spdlog::info("live: {} from {}", FirstPersonIn(state), state.source);
      break;
    case Liveness::kStale:
      spdlog::warn("stale: no data from {} since sample {}", state.source, state.counter);
      break;
  }
}

}  // namespace kinescope::app
