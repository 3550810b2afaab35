#include "core/palette.h"

namespace kinescope {
namespace {

// Of a body 1.75 m tall: just larger than the limb at that joint, so that the sphere shows.
double BaseRadius(int joint) {
  using namespace urdf;
  switch (joint) {
    case jL5S1:
    case jL4L3:
    case jL1T12:
    case jT9T8: return 0.065;
    case jT1C7:
    case jC1Head: return 0.048;
    case jRightShoulder:
    case jLeftShoulder: return 0.056;
    case jRightElbow:
    case jLeftElbow: return 0.046;
    case jRightWrist:
    case jLeftWrist: return 0.038;
    case jRightHip:
    case jLeftHip: return 0.064;
    case jRightKnee:
    case jLeftKnee: return 0.058;
    default: return 0.046;
  }
}

}  // namespace

Rgb ColorOf(LoadClass load_class) {
  switch (load_class) {
    case LoadClass::kLow: return {0.06, 0.60, 0.43};
    case LoadClass::kMedium: return {1.00, 0.58, 0.00};
    case LoadClass::kHigh: return {0.76, 0.08, 0.08};
    case LoadClass::kUnknown: break;
  }
  return {0.30, 0.33, 0.39};
}

double SphereRadius(int joint, LoadClass load_class, double height) {
  double factor = 0.8;  // unknown: smaller than any real class
  if (load_class == LoadClass::kLow) factor = 1.0;
  if (load_class == LoadClass::kMedium) factor = 1.2;
  if (load_class == LoadClass::kHigh) factor = 1.4;
  return BaseRadius(joint) * factor * (height > 0 ? height / 1.75 : 1.0);
}

}  // namespace kinescope
