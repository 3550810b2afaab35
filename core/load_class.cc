#include "core/load_class.h"

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

}  // namespace kinescope
