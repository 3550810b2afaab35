#include "server/ros/bag_person.h"

#include <algorithm>
#include <cstdlib>

namespace kinescope::ros_bridge {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;
using urdf::Pose;

constexpr std::int64_t kDayNanos = 86'400'000'000'000;
constexpr std::int64_t kMilliNanos = 1'000'000;
constexpr std::int64_t kLeastStepNanos = 1'000;  // between two samples

// A person of whom a sample gives other lengths is not measured there.
constexpr double kLongestBone = 1.0;  // m
constexpr double kShortestHuman = 0.4;
constexpr double kTallestHuman = 2.8;
constexpr double kShortestArmBone = 0.05;

// Where the next joint lies in the segment frame of these: along the arm, which is level in the
// T-pose.
struct ArmBone {
  int segment;
  double along_y;
};
constexpr std::array<ArmBone, 4> kArmBones = {{{urdf::kRightUpperArm, -1},
                                               {urdf::kRightForeArm, -1},
                                               {urdf::kLeftUpperArm, 1},
                                               {urdf::kLeftForeArm, 1}}};

}  // namespace

bool BagPerson::HasSegments() const {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (present_.test(At(segment))) return true;
  }
  return false;
}

bool BagPerson::Add(const FrameTransform& transform) {
  const std::size_t slot = At(transform.slot);
  bool cut_short = false;
  if (transform.slot < urdf::kSegmentCount && present_.test(slot)) {
    cut_short = HasSegments();
    present_.reset();
  }
  if (present_.none()) first_record_nanos_ = transform.record_nanos;
  pending_[slot] = transform;
  present_.set(slot);
  return cut_short;
}

BagPerson::Result BagPerson::Finish() {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (!present_.test(At(segment))) return Result::kNothing;
  }
  Poses poses;
  const Result chained = Chain(poses);
  if (chained == Result::kNothing) return chained;  // a link between two segments is still to come
  present_.reset();
  if (chained == Result::kNoTree) return chained;
  const FrameTransform& pelvis = pending_[urdf::kPelvis];
  if (!SetStamp(pelvis.header_nanos, first_record_nanos_)) return Result::kDuplicate;
  SetSegments(poses);
  ++samples_;
  return Result::kSample;
}

BagPerson::Result BagPerson::Chain(Poses& poses) const {
  const std::string* root = nullptr;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const FrameTransform* at = &pending_[At(segment)];
    Pose pose = at->parent_from_child;
    for (int steps = 0; at->parent_slot >= 0; ++steps) {
      if (steps == kFrameSlots) return Result::kNoTree;  // a circle
      if (!present_.test(At(at->parent_slot))) return Result::kNothing;
      at = &pending_[At(at->parent_slot)];
      const Pose& up = at->parent_from_child;
      pose = {up.position + up.orientation * pose.position, up.orientation * pose.orientation};
    }
    if (root != nullptr && *root != at->parent) return Result::kNoTree;
    root = &at->parent;
    poses[At(segment)] = pose;
  }
  return Result::kSample;
}

bool BagPerson::SetStamp(std::int64_t header_nanos, std::int64_t record_nanos) {
  if (headers_are_right_ && samples_ > 0 && header_nanos == last_header_nanos_) return false;
  headers_are_right_ = headers_are_right_ && std::llabs(header_nanos - record_nanos) < kDayNanos &&
                       (samples_ == 0 || header_nanos > last_header_nanos_);
  last_header_nanos_ = header_nanos;
  std::int64_t stamp = headers_are_right_ ? header_nanos : record_nanos;
  if (samples_ == 0) {
    first_stamp_ = stamp;
  } else {
    // Records of one instant, and the change from headers to records, must not turn time round.
    stamp = std::max(stamp, sample_.stamp_nanos + kLeastStepNanos);
  }
  sample_.counter = samples_;
  sample_.stamp_nanos = stamp;
  sample_.time_code_millis = (stamp - first_stamp_ + kMilliNanos / 2) / kMilliNanos;
  return true;
}

void BagPerson::SetSegments(const Poses& poses) {
  if (!arms_are_turned_) FindArmFrames(poses);
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    SegmentState& state = sample_.segments[At(segment)];
    Quaterniond orientation = poses[At(segment)].orientation;
    if (arms_are_turned_.value_or(true)) {
      orientation = orientation * urdf::SegmentFromLink(segment).conjugate();
    }
    orientation.normalize();
    // Both signs mean the same turn; the one nearer to the sample before makes no jump.
    if (samples_ > 0 && orientation.dot(state.orientation) < 0) orientation.coeffs() *= -1;
    state.orientation = orientation;
    state.position = poses[At(segment)].position;
  }
}

void BagPerson::FindArmFrames(const Poses& poses) {
  double level = 0;    // as segment frames have it
  double hanging = 0;  // as link frames have it
  for (const ArmBone& bone : kArmBones) {
    const Pose& from = poses[At(bone.segment)];
    const Vector3d next = poses[At(bone.segment + 1)].position - from.position;
    if (next.norm() < kShortestArmBone) return;  // not a body yet; another sample will tell
    const Vector3d direction = from.orientation.conjugate() * next.normalized();
    level += bone.along_y * direction.y();
    hanging -= direction.z();
  }
  arms_are_turned_ = hanging > level;
}

std::optional<urdf::Skeleton> BagPerson::MeasureSkeleton() const {
  std::array<Vector3d, urdf::kSegmentCount> t_pose;
  t_pose[urdf::kPelvis].setZero();
  for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
    const int parent = urdf::kSegments[At(segment)].parent;
    const SegmentState& from = sample_.segments[At(parent)];
    const Vector3d bone =
        from.orientation.conjugate() * (sample_.segments[At(segment)].position - from.position);
    if (bone.norm() > kLongestBone) return std::nullopt;
    t_pose[At(segment)] = t_pose[At(parent)] + bone;
  }
  urdf::Skeleton skeleton = urdf::SkeletonFromTPose(t_pose, {});
  if (skeleton.height < kShortestHuman || skeleton.height > kTallestHuman) return std::nullopt;
  return skeleton;
}

}  // namespace kinescope::ros_bridge
