#include "server/mvn/scale_group.h"

#include <utility>

namespace kinescope::mvn {
namespace {

constexpr std::int64_t kPatienceNanos = 500'000'000;
constexpr std::size_t kMostLandmarks = 512;  // a current MVN sends 127
constexpr double kShortestHuman = 0.4;       // m
constexpr double kTallestHuman = 2.8;
constexpr double kLongestBone = 1.0;

using Origins = std::array<Eigen::Vector3d, urdf::kSegmentCount>;

// By name and not by number: props, fingers and tracked objects stand in the same list.
std::optional<Origins> OriginsOf(const ScaleMessage& part) {
  Origins origins;
  std::bitset<urdf::kSegmentCount> found;
  for (const ScaleSegment& segment : part.segments) {
    const auto known = urdf::FindSegment(segment.name);
    if (!known) continue;
    origins[static_cast<std::size_t>(*known)] = segment.origin_in_world;
    found.set(static_cast<std::size_t>(*known));
  }
  if (!found.all()) return std::nullopt;
  return origins;
}

bool IsHuman(const Origins& origins) {
  for (std::size_t segment = 1; segment < origins.size(); ++segment) {
    const auto parent = static_cast<std::size_t>(urdf::kSegments[segment].parent);
    if ((origins[segment] - origins[parent]).norm() > kLongestBone) return false;
  }
  const double height = urdf::SkeletonFromTPose(origins, {}).height;
  return height >= kShortestHuman && height <= kTallestHuman;
}

}  // namespace

std::optional<Reason> ScaleGroup::Add(const Header& header, const ScaleMessage& part,
                                      std::int64_t now_nanos) {
  std::optional<Origins> origins;
  if (!part.segments.empty()) {
    origins = OriginsOf(part);
    if (!origins) return Reason::kScaleWithoutBody;
    if (!IsHuman(*origins)) return Reason::kScaleNotHuman;
  }
  // Groups repeat with the same numbers, so segments after segments begin the next one. Points
  // that overtook their segments stay.
  if (taken_ || (origins && origins_)) *this = ScaleGroup();
  parts_.set(static_cast<std::size_t>(header.part));
  if (header.is_last_part) last_part_ = header.part;
  last_part_nanos_ = now_nanos;
  if (origins) origins_ = origins;
  for (const ScalePoint& point : part.points) {
    const double reach = point.offset.norm();
    if (point.segment_id > urdf::kSegmentCount || reach > kLongestBone) continue;
    if (landmarks_.size() >= kMostLandmarks) break;
    landmarks_[{point.segment_id - 1, point.name}] = point.offset;
  }
  return std::nullopt;
}

std::optional<urdf::Skeleton> ScaleGroup::TakeSkeleton(std::int64_t now_nanos) {
  const auto deadline = deadline_nanos();
  if (!deadline || (!IsWhole() && now_nanos < *deadline)) return std::nullopt;
  taken_ = true;
  return urdf::SkeletonFromTPose(*origins_, landmarks_);
}

bool ScaleGroup::IsWhole() const {
  if (!last_part_) return false;
  for (int part = 0; part <= *last_part_; ++part) {
    if (!parts_.test(static_cast<std::size_t>(part))) return false;
  }
  return true;
}

std::optional<std::int64_t> ScaleGroup::deadline_nanos() const {
  if (!origins_ || taken_) return std::nullopt;
  return last_part_nanos_ + kPatienceNanos;
}

}  // namespace kinescope::mvn
