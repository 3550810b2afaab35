#include "core/extra_segments.h"

#include "core/check.h"

namespace kinescope {

std::string ExtraName(int index) {
  KINESCOPE_CHECK(index >= 0 && index < kExtraCount);
  if (index < kMostProps) return "Prop" + std::to_string(index + 1);
  const int finger = index - kMostProps;
  const bool left = finger < kFingersPerHand;
  return (left ? "Left" : "Right") +
         std::string(kFingers[static_cast<std::size_t>(finger % kFingersPerHand)]);
}

}  // namespace kinescope
