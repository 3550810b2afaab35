#include "core/palette.h"

#include <algorithm>
#include <array>

#include "core/skin_inputs.h"
#include "urdf/segments.h"
#include "urdf/skeleton.h"
#include "urdf/skin/skin_template.h"

namespace kinescope {
namespace {

// At most half of the least width of the limb at the joint, of a body 1.75 m tall, m
// (tests/core/sphere_width_test.cc): of average people and of the thinnest. Heavy people have the
// spheres of average ones.
struct LimbWidths {
  double man, woman, thin_man, thin_woman;
};
struct SphereSize {
  LimbWidths limb;  // the class high is as large
  double depth;     // m, from the joint's centre to beyond the skin, clothes and tools on it
};
// By urdf::JointGroup.
constexpr std::array<SphereSize, urdf::kJointGroupCount> kSizes = {{
    {{0.080, 0.080, 0.080, 0.080}, 0.190},      // spine
    {{0.052, 0.051, 0.052, 0.048}, 0.096},      // neck
    {{0.050, 0.050, 0.050, 0.050}, 0.096},      // clavicle
    {{0.0485, 0.045, 0.043, 0.038}, 0.112},     // shoulder: of the upper arm
    {{0.038, 0.038, 0.038, 0.0353}, 0.092},     // elbow
    {{0.0222, 0.0212, 0.0210, 0.0202}, 0.076},  // wrist
    {{0.072, 0.072, 0.069, 0.072}, 0.140},      // hip
    {{0.053, 0.053, 0.0485, 0.0495}, 0.116},    // knee
    {{0.034, 0.034, 0.034, 0.034}, 0.092},      // ankle
    {{0.022, 0.022, 0.022, 0.022}, 0.080},      // ball of the foot
}};
constexpr double kThinnest = -0.45;  // skin::Build::heavy

const SphereSize& SpheresOf(int joint) { return kSizes[urdf::At(urdf::JointGroupOf(joint))]; }

double Scale(double height) { return height > 0 ? height / urdf::kReferenceHeight : 1; }

// Of a body 1.75 m tall, m.
double LimbOf(const LimbWidths& widths, const skin::Build& build) {
  const double thin = std::clamp(build.heavy / kThinnest, 0.0, 1.0);
  const double man = (1 - thin) * widths.man + thin * widths.thin_man;
  const double woman = (1 - thin) * widths.woman + thin * widths.thin_woman;
  return (1 - build.woman) * man + build.woman * woman;
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

double SphereRadius(int joint, LoadClass load_class, const PersonModel& model) {
  return LimbOf(SpheresOf(joint).limb, BuildOf(model)) * SizeOf(load_class) *
         Scale(model.human.skeleton.height);
}

double SphereDepth(int joint, double height) { return SpheresOf(joint).depth * Scale(height); }

MarkSizes MarkSizesOf(double height) {
  const double size = Scale(height);
  return {0.034 * size, 0.068 * size, 0.062 * size, 0.0035 * size, 0.046 * size, 0.038 * size};
}

}  // namespace kinescope
