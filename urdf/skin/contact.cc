#include "urdf/skin/contact.h"

#include <cmath>

#include "urdf/skin/frames.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;
using urdf::At;

// Sizes of a person of kReferenceHeight, m.
FoldShape FoldOf(int segment, const BindPose& bind, double scale) {
  const urdf::Pose& link = bind.links[At(segment)];
  FoldShape fold;
  fold.segment = segment;
  fold.before = {urdf::kSegments[At(segment)].parent};
  fold.frame = SwingFrame(segment, SwingFrames(segment) / 2);
  fold.center = link.position;
  fold.normal = link.orientation * Vector3d::UnitZ();
  fold.across = link.orientation * Vector3d::UnitY();
  fold.inwards = link.orientation * Vector3d::UnitX();
  switch (segment) {
    case urdf::kRightUpperLeg:
    case urdf::kLeftUpperLeg:
      fold.before = {urdf::kPelvis, urdf::kL5, urdf::kL3};
      // The groin rises to the side.
      fold.outwards = Vector3d(0, segment == urdf::kLeftUpperLeg ? 1 : -1, 0);
      fold.normal = (Vector3d::UnitZ() - 0.25 * fold.outwards).normalized();
      fold.across = Vector3d::UnitY();
      fold.inwards = Vector3d::UnitX();
      fold.pressed = {0, 0.05};
      fold.beside_midline = {-0.040, 0.035};
      fold.softness = 0.006;
      fold.bulge = 0.25;
      fold.bulges = {0.10, -0.60};
      break;
    case urdf::kRightLowerLeg:
    case urdf::kLeftLowerLeg:
      fold.inwards *= -1;
      fold.softness = 0.010;
      fold.bulge = 0.25;
      fold.bulges = {-0.40, -1};
      break;
    default:
      fold.bulge = 0.17;
      fold.bulges = {-0.25, -0.95};
      break;
  }
  for (Growth* growth : {&fold.pressed, &fold.bulging, &fold.beside_midline}) {
    *growth = {scale * growth->from, scale * growth->to};
  }
  fold.softness *= scale;
  return fold;
}

// How far a frame is past the joint, 0..1; less than 0: it carries other parts.
double PastOf(const FoldShape& fold, const Frame& frame) {
  if (frame.kind == FrameKind::kFinger || frame.kind == FrameKind::kHalfFinger) return -1;
  const bool is_swing = frame.kind == FrameKind::kSwing;
  if (frame.segment == fold.segment) return is_swing ? frame.share : 1;
  const bool is_before =
      std::find(fold.before.begin(), fold.before.end(), frame.segment) != fold.before.end();
  return is_before && !is_swing ? 0 : -1;
}

}  // namespace

std::array<FoldShape, kFolds> FoldsOf(const BindPose& bind, double height) {
  const double scale = height > 0 ? height / urdf::kReferenceHeight : 1;
  return {FoldOf(urdf::kRightForeArm, bind, scale),  FoldOf(urdf::kLeftForeArm, bind, scale),
          FoldOf(urdf::kRightUpperLeg, bind, scale), FoldOf(urdf::kLeftUpperLeg, bind, scale),
          FoldOf(urdf::kRightLowerLeg, bind, scale), FoldOf(urdf::kLeftLowerLeg, bind, scale)};
}

std::vector<FoldVertex> VerticesOf(const FoldShape& fold, const std::vector<Eigen::Vector3f>& rest,
                                   const std::vector<VertexWeights>& weights) {
  std::vector<double> past_of;
  for (const Frame& frame : Frames()) past_of.push_back(PastOf(fold, frame));
  std::vector<FoldVertex> vertices;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    double whole = 0, past = 0;  // of 255
    for (std::size_t k = 0; k < kInfluences; ++k) {
      const double of_frame = past_of[weights[i].frames[k]];
      if (of_frame < 0) continue;
      whole += weights[i].weights[k];
      past += weights[i].weights[k] * of_frame;
    }
    if (whole == 0) continue;
    const Vector3d p = rest[i].cast<double>(), from_center = p - fold.center;
    const double inwards = fold.inwards.dot(from_center), before = fold.normal.dot(from_center);
    const double side = std::clamp(2 - 4 * past / whole, -1.0, 1.0);
    const double share = whole / 255 * fold.beside_midline.At(fold.outwards.dot(p));
    const double press = side * share * fold.pressed.At(inwards);
    const double bulge = std::abs(side) * share * fold.bulging.At(inwards) * fold.bulge;
    if (press == 0 && bulge == 0) continue;
    vertices.push_back({static_cast<std::uint16_t>(i), static_cast<float>(press),
                        static_cast<float>(std::min(press > 0 ? before : -before, 0.0)),
                        static_cast<float>(bulge)});
  }
  return vertices;
}

}  // namespace kinescope::skin
