#include "urdf/skin/outfit.h"

#include <algorithm>
#include <cmath>

#include "urdf/skin/bind_pose.h"
#include "urdf/skin/frames.h"

namespace kinescope::skin {
namespace {

using Eigen::Vector3d;

// How far a point (left side) is inside of the collar, m: an ellipsoid around the lower neck, which
// crosses neck and shoulders at right angles, so that their muscles do not show in the border.
double AboveCollar(const Vector3d& p, const Vector3d& neck) {
  // m, for a person of kReferenceHeight.
  constexpr double kRadius = 0.1155, kForward = 0.030, kUp = 0.080, kNarrow = 1.25;
  const double up = p.z() - neck.z() - kUp;
  const Vector3d away(p.x() - kForward, kNarrow * p.y(), std::min(up, 0.0));
  return kRadius - away.norm() + std::max(up, 0.0);
}

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
  // m, for a person of kReferenceHeight: over the hips, above the wrist, above the
  // ankle, over the hips, below the shoulder, and half a band's width.
  constexpr double kBelt = 0.088, kCuff = 0.012, kShoeTop = 0.050, kChest = 0.330,
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
    Borders borders;
    borders.trousers = limited(is_arm ? -1 : kBelt - p.z());
    borders.bare =
        limited(is_arm ? -in_hand.z() + kCuff : AboveCollar(p, bind.links[urdf::kNeck].position));
    borders.shoes = limited(is_arm ? -1 : kShoeTop - in_foot.z());
    borders.bands =
        limited(kHalfBand - std::abs(is_arm ? -in_arm.z() - kUpperArm : p.z() - kChest));
    all.push_back(borders);
  }
  return all;
}

bool HasBorder(const std::vector<Borders>& suit, const Triangle& triangle) {
  constexpr float kNear = 0.002f;  // m
  if (suit.empty()) return false;
  const auto is_crossed = [&](float Borders::*border) {
    const auto [least, most] = std::minmax(
        {suit[triangle[0]].*border, suit[triangle[1]].*border, suit[triangle[2]].*border});
    return least < kNear && most > -kNear;
  };
  return is_crossed(&Borders::trousers) || is_crossed(&Borders::bare) ||
         is_crossed(&Borders::shoes) || is_crossed(&Borders::bands);
}

}  // namespace kinescope::skin
