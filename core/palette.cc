#include "core/palette.h"

#include <array>

#include "urdf/segments.h"
#include "urdf/skeleton.h"

namespace kinescope {
namespace {

// By urdf::JointGroup, of a body 1.75 m tall, m: just larger than the limb at that joint, so that
// the sphere shows.
constexpr std::array<double, urdf::kJointGroupCount> kBaseRadius = {
    0.065,  // spine
    0.048,  // neck
    0.046,  // clavicle
    0.056,  // shoulder
    0.046,  // elbow
    0.038,  // wrist
    0.064,  // hip
    0.058,  // knee
    0.046,  // ankle
    0.046,  // ball of the foot
};

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
  const double radius = kBaseRadius[urdf::At(urdf::JointGroupOf(joint))];
  return radius * factor * (height > 0 ? height / urdf::kReferenceHeight : 1.0);
}

}  // namespace kinescope
