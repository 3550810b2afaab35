#include "urdf/skin/load_regions.h"

#include <algorithm>
#include <cmath>

#include "urdf/skin/frames.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;

bool IsArm(BodyPart part) { return part == BodyPart::kRightArm || part == BodyPart::kLeftArm; }

BodyPart PartThatCarries(const VertexWeights& vertex) {
  std::array<int, kBodyParts> shares{};
  for (std::size_t i = 0; i < kInfluences; ++i) {
    const BodyPart part = BodyPartOf(Frames()[vertex.frames[i]].segment);
    shares[static_cast<std::size_t>(part)] += vertex.weights[i];
  }
  const auto largest = std::max_element(shares.begin(), shares.end());
  return *largest < kPartWeight ? BodyPart::kTrunk
                                : static_cast<BodyPart>(largest - shares.begin());
}

RegionShape ShapeOf(int joint, const BindPose& bind, double scale) {
  // Half widths, m, of a person of kReferenceHeight.
  constexpr double kLowBelt = 0.036, kChest = 0.032, kCollar = 0.027, kShoulder = 0.088,
                   kElbow = 0.048, kWrist = 0.030, kHip = 0.104, kKnee = 0.066, kAnkle = 0.034;
  // The middle of a region, in the axes of the world, y outwards, from the joint: on the deltoid,
  // on the greater trochanter; above the iliac crest, below the armpits, above the collar.
  static const Vector3d kDeltoid(0, 0.060, -0.026), kTrochanter(0, 0.085, -0.058);
  constexpr double kAboveL5S1 = 0.026, kBelowT9T8 = 0.080, kAboveT1C7 = 0.036;
  constexpr double kNeckFlare = 6;  // 1/m: 2 cm at the side of the neck, 9 cm out on the shoulders
  const int segment = urdf::ChildOf(joint);
  const urdf::Pose& link = bind.links[urdf::At(segment)];
  const BodyPart own = BodyPartOf(segment);
  RegionShape shape;
  const auto add = [&](BodyPart part) { shape.parts.set(static_cast<std::size_t>(part)); };
  const auto band = [&](const Vector3d& direction, double half, double above = 0) {
    for (std::size_t i = 0; i < kBodyParts; ++i) {
      const auto part = static_cast<BodyPart>(i);
      if (own == BodyPart::kTrunk ? !IsArm(part) : part == own) add(part);
    }
    shape.middle = link.position + above * scale * Vector3d::UnitZ();
    shape.direction = direction;
    shape.half_width = half * scale;
    return shape;
  };
  const auto ball = [&](const Vector3d& middle, double radius) {
    const double outward = urdf::IsLeftJoint(joint) ? 1 : -1;
    add(own);
    add(BodyPart::kTrunk);
    shape.is_ball = true;
    shape.middle = link.position + scale * middle.cwiseProduct(Vector3d(1, outward, 1));
    shape.half_width = radius * scale;
    return shape;
  };
  const Vector3d along_bone = link.orientation * Vector3d::UnitZ();
  const Vector3d forward_of_neck(0.55, 0, 1);
  switch (urdf::JointGroupOf(joint)) {
    case urdf::JointGroup::kSpine:
      return joint == urdf::jL5S1 ? band(Vector3d::UnitZ(), kLowBelt, kAboveL5S1)
                                  : band(Vector3d::UnitZ(), kChest, -kBelowT9T8);
    case urdf::JointGroup::kNeck:
      shape.flare = kNeckFlare / scale;
      return band(forward_of_neck, kCollar, kAboveT1C7);
    case urdf::JointGroup::kShoulder: return ball(kDeltoid, kShoulder);
    case urdf::JointGroup::kElbow: return band(along_bone, kElbow);
    case urdf::JointGroup::kWrist: return band(along_bone, kWrist);
    case urdf::JointGroup::kHip: return ball(kTrochanter, kHip);
    case urdf::JointGroup::kKnee: return band(along_bone, kKnee);
    case urdf::JointGroup::kAnkle: return band(Vector3d::UnitZ(), kAnkle);
    case urdf::JointGroup::kClavicle:
    case urdf::JointGroup::kBallOfFoot: break;  // their loads are not computed
  }
  return shape;
}

double Inside(const RegionShape& shape, BodyPart part, const Vector3d& p) {
  if (!shape.parts.test(static_cast<std::size_t>(part))) return -1;
  const Vector3d from_middle = p - shape.middle;
  const double along =
      shape.direction.dot(from_middle) - shape.flare * from_middle.y() * from_middle.y();
  const double away = shape.is_ball ? from_middle.norm() : std::abs(along);
  return 1 - away / shape.half_width;
}

// Large triangles and unusual bodies may have vertices of two regions.
void KeepApart(const Triangle& t, std::vector<LoadRegion>& regions) {
  if (regions[t[0]].joint == regions[t[1]].joint && regions[t[1]].joint == regions[t[2]].joint) {
    return;
  }
  constexpr float kOutside = -0.01f;
  for (const auto corner : t) {
    regions[corner].inside = std::min(regions[corner].inside, kOutside);
  }
}

}  // namespace

BodyPart BodyPartOf(int segment) {
  if (segment >= urdf::kRightUpperArm && segment <= urdf::kRightHand) return BodyPart::kRightArm;
  if (segment >= urdf::kLeftUpperArm && segment <= urdf::kLeftHand) return BodyPart::kLeftArm;
  if (segment >= urdf::kRightUpperLeg && segment <= urdf::kRightToe) return BodyPart::kRightLeg;
  if (segment >= urdf::kLeftUpperLeg && segment <= urdf::kLeftToe) return BodyPart::kLeftLeg;
  return BodyPart::kTrunk;
}

RegionShapes RegionShapesOf(const BindPose& bind, double height) {
  const double scale = height > 0 ? height / urdf::kReferenceHeight : 1;
  RegionShapes shapes;
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    shapes[i] = ShapeOf(urdf::kScoredJoints[i], bind, scale);
  }
  return shapes;
}

std::optional<std::size_t> RegionOf(int joint) {
  const auto& joints = urdf::kScoredJoints;
  const auto found = std::find(joints.begin(), joints.end(), joint);
  if (found == joints.end()) return std::nullopt;
  return static_cast<std::size_t>(found - joints.begin());
}

std::vector<LoadRegion> LoadRegionsOf(const std::vector<Eigen::Vector3f>& rest,
                                      const std::vector<VertexWeights>& weights,
                                      const std::vector<Triangle>& triangles, const BindPose& bind,
                                      double height) {
  const RegionShapes shapes = RegionShapesOf(bind, height);
  std::vector<LoadRegion> regions(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const BodyPart part = PartThatCarries(weights[i]);
    for (std::size_t joint = 0; joint < urdf::kScoredJointCount; ++joint) {
      const double inside = Inside(shapes[joint], part, rest[i].cast<double>());
      if (inside > regions[i].inside) {
        regions[i] = {static_cast<std::uint8_t>(joint), static_cast<float>(inside)};
      }
    }
  }
  for (const Triangle& t : triangles) KeepApart(t, regions);
  return regions;
}

}  // namespace kinescope::skin
