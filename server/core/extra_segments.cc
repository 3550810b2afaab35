#include "server/core/extra_segments.h"

#include "server/core/check.h"

namespace kinescope {

const std::array<std::string_view, kFingersPerHand> kFingers = {
    "Carpus",   "FirstMC",  "FirstPP", "FirstDP", "SecondMC", "SecondPP", "SecondMP",
    "SecondDP", "ThirdMC",  "ThirdPP", "ThirdMP", "ThirdDP",  "FourthMC", "FourthPP",
    "FourthMP", "FourthDP", "FifthMC", "FifthPP", "FifthMP",  "FifthDP"};

const std::array<int, kFingersPerHand> kFingerParents = {-1, 0,  1, 2,  0,  4,  5, 6,  0,  8,
                                                         9,  10, 0, 12, 13, 14, 0, 16, 17, 18};

std::string ExtraName(int index) {
  KINESCOPE_CHECK(index >= 0 && index < kExtraCount);
  if (index < kMostProps) return "Prop" + std::to_string(index + 1);
  const int finger = index - kMostProps;
  const bool left = finger < kFingersPerHand;
  return (left ? "Left" : "Right") +
         std::string(kFingers[static_cast<std::size_t>(finger % kFingersPerHand)]);
}

}  // namespace kinescope
