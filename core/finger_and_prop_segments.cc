#include "core/finger_and_prop_segments.h"

#include "core/system/check.h"

namespace kinescope {

std::string FingerOrPropName(int index) {
  KINESCOPE_CHECK(index >= 0 && index < kFingerAndPropCount);
  if (index < kMaxProps) return "Prop" + std::to_string(index + 1);
  const int finger = index - kMaxProps;
  const bool left = finger < kFingersPerHand;
  return (left ? "Left" : "Right") +
         std::string(kFingers[static_cast<std::size_t>(finger % kFingersPerHand)]);
}

}  // namespace kinescope
