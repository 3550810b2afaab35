#include "core/palette.h"

#include <array>

#include "urdf/segments.h"
#include "urdf/skeleton.h"

namespace kinescope {
namespace {

// By urdf::JointGroup, of a body 1.75 m tall.
struct SphereSize {
  double limb;   // half of the limb's least thickness at the joint, m: the class high is as large
  double depth;  // m, from the joint's centre to beyond the skin, clothes and tools on it
};
constexpr std::array<SphereSize, urdf::kJointGroupCount> kSizes = {{
    {0.080, 0.190},   // spine
    {0.052, 0.096},   // neck
    {0.050, 0.096},   // clavicle
    {0.051, 0.112},   // shoulder
    {0.038, 0.092},   // elbow
    {0.0225, 0.076},  // wrist
    {0.072, 0.140},   // hip
    {0.053, 0.116},   // knee
    {0.034, 0.092},   // ankle
    {0.022, 0.080},   // ball of the foot
}};

const SphereSize& SpheresOf(int joint) { return kSizes[urdf::At(urdf::JointGroupOf(joint))]; }

double Scale(double height) { return height > 0 ? height / urdf::kReferenceHeight : 1; }

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

double SizeOf(LoadClass load_class) {
  switch (load_class) {
    case LoadClass::kLow: return 0.71;
    case LoadClass::kMedium: return 0.85;
    case LoadClass::kHigh: return 1;
    case LoadClass::kUnknown: break;
  }
  return 0.57;
}

double RimOf(LoadClass load_class) {
  switch (load_class) {
    case LoadClass::kHigh: return 1;
    case LoadClass::kUnknown: return -0.8;
    case LoadClass::kLow:
    case LoadClass::kMedium: break;
  }
  return 0;
}

double SphereRadius(int joint, LoadClass load_class, double height) {
  return SpheresOf(joint).limb * SizeOf(load_class) * Scale(height);
}

double SphereDepth(int joint, double height) { return SpheresOf(joint).depth * Scale(height); }

}  // namespace kinescope
