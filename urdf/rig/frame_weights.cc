#include "urdf/rig/frame_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "urdf/skin/frames.h"

namespace kinescope::rig {
namespace {

using Eigen::Vector3d;
using urdf::At;
using BySegment = std::array<double, urdf::kSegmentCount>;
using ByFrame = std::map<int, double>;

// Where along a bone it begins and ends to twist, m from its joint, as of the built-in skin
// (urdf/skin/make/weights.cc).
std::pair<double, double> TwistRange(int segment) {
  switch (segment) {
    case urdf::kRightForeArm:
    case urdf::kLeftForeArm: return {0.040, 0.220};
    case urdf::kRightUpperLeg:
    case urdf::kLeftUpperLeg: return {0.070, 0.370};
    default: return {0.100, 0.250};
  }
}

// The share of a segment: its own frame, or those that twist by part of it.
void AddSegment(int segment, double mass, const Vector3d& position, const skin::BindPose& bind,
                ByFrame& frames) {
  const int twists = skin::TwistFrames(segment);
  if (twists == 0) {
    frames[skin::SegmentFrame(segment)] += mass;
    return;
  }
  const double along = -skin::InLink(bind.links[At(segment)], position).z();
  const auto [from, to] = TwistRange(segment);
  const double twist = std::clamp((along - from) / (to - from), 0.0, 1.0) * twists;
  const int below = std::min(static_cast<int>(twist), twists - 1);
  const double above = twist - below;
  frames[skin::TwistFrame(segment, below)] += mass * (1 - above);
  frames[below + 1 < twists ? skin::TwistFrame(segment, below + 1) : skin::SegmentFrame(segment)] +=
      mass * above;
}

// Between two segments that share the joint of `child`: turned by the child's part of them.
void AddJoint(int parent, int child, double of_parent, double of_child, const Vector3d& position,
              const skin::BindPose& bind, ByFrame& frames) {
  const double mass = of_parent + of_child;
  const int swings = skin::SwingFrames(child);
  if (swings == 0) {
    AddSegment(parent, of_parent, position, bind, frames);
    AddSegment(child, of_child, position, bind, frames);
    return;
  }
  const double at = of_child / mass * (swings + 1);
  const int below = std::min(static_cast<int>(at), swings);
  const auto add = [&](int step, double share) {
    if (step == 0) {
      AddSegment(parent, mass * share, position, bind, frames);
    } else if (step > swings) {
      AddSegment(child, mass * share, position, bind, frames);
    } else {
      frames[skin::SwingFrame(child, step - 1)] += mass * share;
    }
  };
  add(below, 1 - (at - below));
  add(below + 1, at - below);
}

// The segment that the joint of `segment` is shared with: the nearest one that carries anything;
// where a rig has no clavicle or neck, the trunk. -1: none.
int PartnerOf(int segment, const BySegment& masses) {
  const int parent = urdf::kSegments[At(segment)].parent;
  if (parent < 0 || masses[At(parent)] > 0) return parent;
  const bool may_skip =
      segment == urdf::kRightUpperArm || segment == urdf::kLeftUpperArm || segment == urdf::kHead;
  const int above = urdf::kSegments[At(parent)].parent;
  return may_skip && masses[At(above)] > 0 ? above : -1;
}

// Rigs cut the spine in other places than MVN: its vertices go with the segments at their height.
void SpreadTrunk(const Vector3d& position, const skin::BindPose& bind, BySegment& masses) {
  constexpr double kHalfRamp = 0.045;  // m
  double rest = 0;
  for (int segment = urdf::kPelvis; segment <= urdf::kT8; ++segment) rest += masses[At(segment)];
  for (int segment = urdf::kT8; segment > urdf::kPelvis; --segment) {
    const double above = position.z() - bind.links[At(segment)].position.z();
    const double t = std::clamp((above + kHalfRamp) / (2 * kHalfRamp), 0.0, 1.0);
    masses[At(segment)] = rest * t * t * (3 - 2 * t);
    rest -= masses[At(segment)];
  }
  masses[urdf::kPelvis] = rest;
}

// The heaviest four, in shares of 255; rounding goes to the first.
skin::VertexWeights Heaviest(const ByFrame& frames) {
  std::vector<std::pair<double, int>> order;
  for (const auto& [frame, mass] : frames) {
    if (mass > 0) order.emplace_back(-mass, frame);
  }
  std::sort(order.begin(), order.end());
  order.resize(std::min(order.size(), skin::kInfluences));
  double sum = 0;
  for (const auto& [mass, frame] : order) sum -= mass;
  skin::VertexWeights weights;
  int rest = 255;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto share = static_cast<int>(std::lround(-order[i].first / sum * 255));
    weights.frames[i] = static_cast<std::uint8_t>(order[i].second);
    weights.weights[i] = static_cast<std::uint8_t>(share);
    rest -= share;
  }
  weights.weights[0] = static_cast<std::uint8_t>(weights.weights[0] + rest);
  return weights;
}

}  // namespace

skin::VertexWeights WeightsOf(const RigVertex& vertex, const Vector3d& position, const Bones& bones,
                              const skin::BindPose& bind) {
  BySegment masses{};
  ByFrame frames;
  for (std::size_t k = 0; k < vertex.nodes.size(); ++k) {
    const double weight = static_cast<double>(vertex.weights[k]);
    if (!(weight > 0)) continue;
    const std::size_t node = At(vertex.nodes[k]);
    if (bones.has_frames) {
      const int frame = bones.frame_of[node];
      frames[frame >= 0 ? frame : skin::SegmentFrame(std::max(bones.segment_of[node], 0))] +=
          weight;
    } else {
      masses[At(std::max(bones.segment_of[node], 0))] += weight;
    }
  }
  if (bones.has_frames) return Heaviest(frames);
  if (!bones.has_spine_of_mvn) SpreadTrunk(position, bind, masses);
  // Each segment shares its mass among its joints, by what is on their other side.
  BySegment partners{};
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const int partner = masses[At(segment)] > 0 ? PartnerOf(segment, masses) : -1;
    if (partner < 0) continue;
    partners[At(segment)] += masses[At(partner)];
    partners[At(partner)] += masses[At(segment)];
  }
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const double mass = masses[At(segment)];
    if (!(mass > 0)) continue;
    if (partners[At(segment)] == 0) AddSegment(segment, mass, position, bind, frames);
    const int partner = PartnerOf(segment, masses);
    if (partner < 0) continue;
    const double other = masses[At(partner)];
    AddJoint(partner, segment, other * mass / partners[At(partner)],
             mass * other / partners[At(segment)], position, bind, frames);
  }
  return Heaviest(frames);
}

}  // namespace kinescope::rig
