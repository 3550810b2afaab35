#include "urdf/skin/outfit.h"

#include <algorithm>
#include <cmath>

#include "urdf/skin/bind_pose.h"
#include "urdf/skin/frames.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;

// Whether arm or hand carry most of the vertex.
bool IsOfArm(const VertexWeights& vertex) {
  int of_arm = 0;
  for (std::size_t i = 0; i < kInfluences; ++i) {
    const int segment = Frames()[vertex.frames[i]].segment;
    const bool is_arm = (segment >= urdf::kRightUpperArm && segment <= urdf::kRightHand) ||
                        (segment >= urdf::kLeftUpperArm && segment <= urdf::kLeftHand);
    of_arm += is_arm ? vertex.weights[i] : 0;
  }
  return of_arm > 127;
}

}  // namespace

std::vector<Borders> OutfitOf(const SkinTemplate& skin, const Build& build) {
  // m, for a person of kReferenceHeight: over the hips, around the neck, above the wrist, above the
  // ankle, over the hips, below the shoulder, and half a band's width.
  constexpr double kBelt = 0.088, kCollar = 0.006, kCuff = 0.012, kShoeTop = 0.050, kChest = 0.330,
                   kUpperArm = 0.165, kHalfBand = 0.014;
  const BindPose bind = BindPoseOf(urdf::DefaultSkeleton());
  const std::vector<Eigen::Vector3f> positions = skin.Blend(build);
  std::vector<Borders> all;
  all.reserve(positions.size());
  const auto limited = [](double inside) {
    return std::clamp(static_cast<float>(inside), -kFarthestBorder, kFarthestBorder);
  };
  for (std::size_t i = 0; i < positions.size(); ++i) {
    Vector3d p = positions[i].cast<double>();
    p.y() = std::abs(p.y());
    const bool is_arm = IsOfArm(skin.weights[i]);
    const Vector3d in_arm = InLink(bind.links[urdf::kLeftUpperArm], p);
    const Vector3d in_hand = InLink(bind.links[urdf::kLeftHand], p);
    const Vector3d in_foot = p - bind.links[urdf::kLeftFoot].position;
    const double above_collar =
        p.z() - bind.links[urdf::kNeck].position.z() + 0.55 * p.x() - kCollar;
    Borders borders;
    borders.trousers = limited(is_arm ? -1 : kBelt - p.z());
    borders.bare = limited(is_arm ? -in_hand.z() + kCuff : above_collar - 0.35 * p.y());
    borders.shoes = limited(is_arm ? -1 : kShoeTop - in_foot.z());
    borders.bands =
        limited(kHalfBand - std::abs(is_arm ? -in_arm.z() - kUpperArm : p.z() - kChest));
    all.push_back(borders);
  }
  return all;
}

}  // namespace kinescope::skin
