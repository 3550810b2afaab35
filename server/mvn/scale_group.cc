#include "server/mvn/scale_group.h"

#include <utility>

namespace kinescope::mvn {
namespace {

constexpr std::int64_t kPatienceNanos = 500'000'000;
constexpr double kShortestHuman = 0.4;  // m
constexpr double kTallestHuman = 2.8;
constexpr double kLongestBone = 1.0;

using Origins = std::array<Eigen::Vector3d, urdf::kSegmentCount>;

// The index of a finger segment in FingerAndPropSegments; nullopt for other names.
std::optional<std::size_t> FindFinger(const std::string& name) {
  for (int index = kMaxProps; index < kFingerAndPropCount; ++index) {
    if (FingerOrPropName(index) == name) return static_cast<std::size_t>(index);
  }
  return std::nullopt;
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

// By name and not by number: props, fingers and tracked objects are in the same list.
std::optional<Reason> ScaleGroup::Read(const ScaleMessage& part, Segments& segments) {
  Origins origins;
  std::bitset<urdf::kSegmentCount> found;
  std::vector<ScaledSegment> others;
  for (const ScaleSegment& segment : part.segments) {
    if (const auto known = urdf::FindSegment(segment.name)) {
      origins[static_cast<std::size_t>(*known)] = segment.origin_in_world;
      found.set(static_cast<std::size_t>(*known));
    } else {
      others.push_back({segment.name, segment.origin_in_world});
    }
  }
  if (found.none()) {
    if (others.size() > urdf::kSegmentCount) return Reason::kScaleWithoutBody;
    segments.scaled_segments = std::move(others);
    return std::nullopt;
  }
  if (!found.all()) return Reason::kScaleWithoutBody;
  if (!IsHuman(origins)) return Reason::kScaleNotHuman;
  segments.body = origins;
  int props = 0;
  for (ScaledSegment& segment : others) {
    auto index = FindFinger(segment.name);
    if (!index && props < kMaxProps) index = static_cast<std::size_t>(PropIndex(props++));
    if (!index) continue;
    segments.scaled_segments.resize(kFingerAndPropCount);
    segments.scaled_segments[*index] = std::move(segment);
  }
  return std::nullopt;
}

std::optional<Reason> ScaleGroup::Add(const Header& header, const ScaleMessage& part,
                                      std::int64_t now_nanos) {
  std::optional<Segments> segments;
  if (!part.segments.empty()) {
    segments.emplace();
    if (const auto refused = Read(part, *segments)) return refused;
  }
  // Groups repeat with the same numbers, so segments after segments begin the next one. Points that
  // arrived before their segments stay.
  if (taken_ || (segments && segments_)) *this = ScaleGroup();
  parts_.set(static_cast<std::size_t>(header.part));
  if (header.is_last_part) last_part_ = header.part;
  last_part_nanos_ = now_nanos;
  if (segments) segments_ = std::move(segments);
  for (const ScalePoint& point : part.points) {
    const double reach = point.offset.norm();
    if (point.segment_id > urdf::kSegmentCount || reach > kLongestBone) continue;
    if (landmarks_.size() >= urdf::kMaxLandmarks) break;
    landmarks_.push_back(
        {point.segment_id - 1, point.point_id, point.name, point.offset, point.flags});
  }
  return std::nullopt;
}

std::optional<ScaleGroup::Scale> ScaleGroup::Take(std::int64_t now_nanos) {
  const auto deadline = deadline_nanos();
  if (!deadline || (!IsWhole() && now_nanos < *deadline)) return std::nullopt;
  taken_ = true;
  Scale scale;
  if (segments_->body) {
    scale.skeleton = urdf::SkeletonFromTPose(*segments_->body, landmarks_);
    scale.landmarks = std::move(landmarks_);
  }
  scale.scaled_segments = segments_->scaled_segments;
  return scale;
}

bool ScaleGroup::IsWhole() const {
  if (!last_part_) return false;
  for (int part = 0; part <= *last_part_; ++part) {
    if (!parts_.test(static_cast<std::size_t>(part))) return false;
  }
  return true;
}

std::optional<std::int64_t> ScaleGroup::deadline_nanos() const {
  if (!segments_ || taken_) return std::nullopt;
  return last_part_nanos_ + kPatienceNanos;
}

}  // namespace kinescope::mvn
