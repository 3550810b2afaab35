#include "core/scene_state.h"

namespace kinescope {

const char* Name(LoadClass load_class) {
  switch (load_class) {
    case LoadClass::kLow: return "low";
    case LoadClass::kMedium: return "medium";
    case LoadClass::kHigh: return "high";
    case LoadClass::kUnknown: break;
  }
  return "unknown";
}

const char* Name(Liveness liveness) {
  switch (liveness) {
    case Liveness::kLive: return "live";
    case Liveness::kStale: return "stale";
    case Liveness::kNoData: break;
  }
  return "no data";
}

}  // namespace kinescope
