#include "core/scene_state.h"

namespace kinescope {

const char* Name(Liveness liveness) {
  switch (liveness) {
    case Liveness::kLive: return "live";
    case Liveness::kStale: return "stale";
    case Liveness::kNoPerson: return "no person";
    case Liveness::kNoData: break;
  }
  return "no data";
}

}  // namespace kinescope
