#include "urdf/skin/load_regions.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "urdf/skin/frames.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;

enum class Part { kTrunk, kRightArm, kLeftArm, kRightLeg, kLeftLeg };
constexpr std::size_t kParts = 5;

bool IsArm(Part part) { return part == Part::kRightArm || part == Part::kLeftArm; }

Part PartOf(int segment) {
  if (segment >= urdf::kRightUpperArm && segment <= urdf::kRightHand) return Part::kRightArm;
  if (segment >= urdf::kLeftUpperArm && segment <= urdf::kLeftHand) return Part::kLeftArm;
  if (segment >= urdf::kRightUpperLeg && segment <= urdf::kRightToe) return Part::kRightLeg;
  if (segment >= urdf::kLeftUpperLeg && segment <= urdf::kLeftToe) return Part::kLeftLeg;
  return Part::kTrunk;
}

// The one that carries nearly all of the vertex; else the trunk.
Part PartOf(const VertexWeights& vertex) {
  constexpr int kNearlyAll = 230;  // of 255
  std::array<int, kParts> shares{};
  for (std::size_t i = 0; i < kInfluences; ++i) {
    const Part part = PartOf(Frames()[vertex.frames[i]].segment);
    shares[static_cast<std::size_t>(part)] += vertex.weights[i];
  }
  const auto largest = std::max_element(shares.begin(), shares.end());
  return *largest < kNearlyAll ? Part::kTrunk : static_cast<Part>(largest - shares.begin());
}

// The distance inside the region of `joint`, as a share of the region's own half width.
double Inside(int joint, Part part, const Vector3d& p, const BindPose& bind, double scale) {
  // Half widths, m, of a person of kReferenceHeight.
  constexpr double kLowBelt = 0.036, kChest = 0.032, kCollar = 0.027, kShoulder = 0.088,
                   kElbow = 0.048, kWrist = 0.030, kHip = 0.104, kKnee = 0.066, kAnkle = 0.034;
  // The middle of a region, in the axes of the world, y outwards, from the joint: on the deltoid,
  // on the greater trochanter; above the iliac crest, below the armpits, above the collar.
  static const Vector3d kDeltoid(0, 0.060, -0.026), kTrochanter(0, 0.085, -0.058);
  constexpr double kAboveL5S1 = 0.026, kBelowT9T8 = 0.080, kAboveT1C7 = 0.036;
  const int segment = urdf::ChildOf(joint);
  const urdf::Pose& link = bind.links[urdf::At(segment)];
  const Part own = PartOf(segment);
  const auto band = [&](double from_middle, double half) {
    const bool is_around = own == Part::kTrunk ? !IsArm(part) : part == own;
    return is_around ? 1 - std::abs(from_middle) / (half * scale) : -1;
  };
  const auto ball = [&](const Vector3d& middle, double radius) {
    const double outward = urdf::IsLeftJoint(joint) ? 1 : -1;
    const Vector3d center = link.position + scale * middle.cwiseProduct(Vector3d(1, outward, 1));
    return part == own || part == Part::kTrunk ? 1 - (p - center).norm() / (radius * scale) : -1;
  };
  const Vector3d in_link = InLink(link, p), from = p - link.position;
  switch (urdf::JointGroupOf(joint)) {
    case urdf::JointGroup::kSpine:
      return joint == urdf::jL5S1 ? band(from.z() - kAboveL5S1 * scale, kLowBelt)
                                  : band(from.z() + kBelowT9T8 * scale, kChest);
    case urdf::JointGroup::kNeck:
      return band(from.z() + 0.55 * from.x() - kAboveT1C7 * scale, kCollar);
    case urdf::JointGroup::kShoulder: return ball(kDeltoid, kShoulder);
    case urdf::JointGroup::kElbow: return band(in_link.z(), kElbow);
    case urdf::JointGroup::kWrist: return band(in_link.z(), kWrist);
    case urdf::JointGroup::kHip: return ball(kTrochanter, kHip);
    case urdf::JointGroup::kKnee: return band(in_link.z(), kKnee);
    case urdf::JointGroup::kAnkle: return band(from.z(), kAnkle);
    case urdf::JointGroup::kClavicle:
    case urdf::JointGroup::kBallOfFoot: break;  // their loads are not computed
  }
  return -1;
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
  const double scale = height > 0 ? height / urdf::kReferenceHeight : 1;
  std::vector<LoadRegion> regions(rest.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Part part = PartOf(weights[i]);
    for (std::size_t joint = 0; joint < urdf::kScoredJointCount; ++joint) {
      const double inside =
          Inside(urdf::kScoredJoints[joint], part, rest[i].cast<double>(), bind, scale);
      if (inside > regions[i].inside) {
        regions[i] = {static_cast<std::uint8_t>(joint), static_cast<float>(inside)};
      }
    }
  }
  for (const Triangle& t : triangles) KeepApart(t, regions);
  return regions;
}

}  // namespace kinescope::skin
