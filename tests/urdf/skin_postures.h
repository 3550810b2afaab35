/// Postures of a skin for its tests.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <utility>
#include <vector>

#include "urdf/kinematics.h"
#include "urdf/skin/frames.h"
#include "urdf/skin/person_skin.h"

namespace kinescope::skin {

inline constexpr double kDegree = 3.14159265358979323846 / 180;

inline PersonSkin SkinOf(bool is_woman, double height, double mass) {
  return PersonSkin(BuiltInSkin(), BuildOf(is_woman, height, mass), urdf::DefaultSkeleton(height));
}

/// `links` with one joint turned further, about an axis of its child link.
inline urdf::LinkPoses TurnedAt(urdf::LinkPoses links, int joint, const Eigen::Vector3d& axis,
                                double degrees) {
  const int child = urdf::ChildOf(joint);
  const urdf::Pose center = links[urdf::At(child)];
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(degrees * kDegree, center.orientation * axis));
  std::vector<bool> moves(urdf::kSegmentCount, false);
  moves[urdf::At(child)] = true;
  for (int segment = child; segment < urdf::kSegmentCount; ++segment) {
    const int parent = urdf::kSegments[urdf::At(segment)].parent;
    if (parent >= 0 && moves[urdf::At(parent)]) moves[urdf::At(segment)] = true;
    if (!moves[urdf::At(segment)]) continue;
    urdf::Pose& link = links[urdf::At(segment)];
    link.position = center.position + turn * (link.position - center.position);
    link.orientation = turn * link.orientation;
  }
  return links;
}

/// The skin cut into rigid parts: each vertex follows the segment whose frames carry most of it.
inline std::vector<Eigen::Vector3f> PosedAsRigidParts(const PersonSkin& skin,
                                                      const urdf::LinkPoses& links) {
  std::vector<Eigen::Vector3f> positions;
  positions.reserve(skin.rest().size());
  for (std::size_t i = 0; i < skin.rest().size(); ++i) {
    const VertexWeights& vertex = BuiltInSkin().weights[i];
    std::array<int, urdf::kSegmentCount> sums{};
    for (std::size_t k = 0; k < kInfluences; ++k) {
      sums[urdf::At(Frames()[vertex.frames[k]].segment)] += vertex.weights[k];
    }
    std::size_t strongest = 0;
    for (std::size_t segment = 1; segment < sums.size(); ++segment) {
      if (sums[segment] > sums[strongest]) strongest = segment;
    }
    const urdf::Pose& from = skin.bind().links[strongest];
    const urdf::Pose& to = links[strongest];
    const Eigen::Vector3d in_link = InLink(from, skin.rest()[i].cast<double>());
    positions.push_back((to.position + to.orientation * in_link).cast<float>());
  }
  return positions;
}

/// Of a closed surface, m^3; where it overlaps itself, it counts twice.
inline double SignedVolume(const std::vector<Eigen::Vector3f>& positions,
                           const std::vector<Triangle>& triangles) {
  double volume = 0;
  for (const Triangle& t : triangles) {
    const Eigen::Vector3d a = positions[t[0]].cast<double>(), b = positions[t[1]].cast<double>(),
                          c = positions[t[2]].cast<double>();
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

}  // namespace kinescope::skin
