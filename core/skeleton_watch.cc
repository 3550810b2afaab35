#include "core/skeleton_watch.h"

#include <algorithm>
#include <cmath>

namespace kinescope {
namespace {

using Eigen::Vector3d;
using urdf::At;

// Beyond these limits it is not a person, and is not measured.
constexpr double kLongestBone = 1.0;  // m
constexpr double kShortestHuman = 0.4;
constexpr double kTallestHuman = 2.8;

std::optional<urdf::Skeleton> SkeletonOf(const BodySample& sample) {
  std::array<Vector3d, urdf::kSegmentCount> t_pose;
  t_pose[urdf::kPelvis].setZero();
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const int parent = urdf::kSegments[At(segment)].parent;
    const SegmentState& from = sample.segments[At(parent)];
    const Vector3d bone =
        from.orientation.conjugate() * (sample.segments[At(segment)].position - from.position);
    if (bone.norm() > kLongestBone) return std::nullopt;
    t_pose[At(segment)] = t_pose[At(parent)] + bone;
  }
  urdf::Skeleton skeleton = urdf::SkeletonFromTPose(t_pose, {});
  if (skeleton.height < kShortestHuman || skeleton.height > kTallestHuman) return std::nullopt;
  return skeleton;
}

}  // namespace

SkeletonWatch::Lengths SkeletonWatch::Measure(const BodySample& sample) {
  Lengths lengths{};
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const int parent = urdf::kSegments[At(segment)].parent;
    lengths[At(segment)] =
        (sample.segments[At(segment)].position - sample.segments[At(parent)].position).norm();
  }
  return lengths;
}

bool SkeletonWatch::Agree(const Lengths& a, const Lengths& b) {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double x, double y) { return std::abs(x - y) <= kOtherLength; });
}

std::optional<urdf::Skeleton> SkeletonWatch::Look(const BodySample& sample) {
  const Lengths lengths = Measure(sample);
  if (known_ && Agree(lengths, *known_)) {
    candidate_.reset();
    return std::nullopt;
  }
  if (known_ && !(candidate_ && Agree(lengths, *candidate_))) {
    candidate_ = lengths;
    since_ = sample.stamp_nanos;
  }
  if (known_ && sample.stamp_nanos - since_ < kForGoodNanos) return std::nullopt;
  auto skeleton = SkeletonOf(sample);
  if (!skeleton) return std::nullopt;
  known_ = lengths;
  candidate_.reset();
  return skeleton;
}

}  // namespace kinescope
