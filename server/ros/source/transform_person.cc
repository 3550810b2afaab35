#include "server/ros/source/transform_person.h"

#include <algorithm>
#include <cstdlib>

#include "core/node_clock.h"
#include "core/system/clocks.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;
using urdf::Pose;

constexpr std::int64_t kMinStepNanos = 1'000;  // between two samples

constexpr double kShortestArmBone = 0.05;  // m

// Direction of the next joint in the segment frames of the arms: along the arm, which is horizontal
// in the T-pose.
struct ArmBone {
  int segment;
  double along_y;
};
constexpr std::array<ArmBone, 4> kArmBones = {{{urdf::kRightUpperArm, -1},
                                               {urdf::kRightForeArm, -1},
                                               {urdf::kLeftUpperArm, 1},
                                               {urdf::kLeftForeArm, 1}}};

}  // namespace

bool IsOfRecordTime(std::int64_t header_nanos, std::int64_t record_nanos) {
  return std::abs(header_nanos - record_nanos) < NodeClock::kFarNanos;
}

bool TransformPerson::HasSegments() const {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (present_.test(At(segment))) return true;
  }
  return false;
}

bool TransformPerson::Begin(const Slots& slots) {
  bool has_again = false;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    has_again = has_again || (present_.test(At(segment)) && slots.test(At(segment)));
  }
  if (has_again) present_.reset();
  return has_again;
}

bool TransformPerson::Add(const FrameTransform& transform) {
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

void TransformPerson::AddStatic(const FrameTransform& transform) {
  static_[At(transform.slot)] = transform;
  is_static_.set(At(transform.slot));
}

const FrameTransform* TransformPerson::Find(int slot) const {
  if (present_.test(At(slot))) return &pending_[At(slot)];
  return is_static_.test(At(slot)) ? &static_[At(slot)] : nullptr;
}

TransformPerson::Result TransformPerson::Finish(std::int64_t arrival_nanos, SampleOrigin& origin) {
  if (!HasSegments()) return Result::kNothing;
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (Find(segment) == nullptr) return Result::kNothing;
  }
  Poses poses;
  const std::string* root = nullptr;
  const Result chained = Chain(poses, root);
  if (chained == Result::kNothing) return chained;  // a link between two segments is still missing
  const std::int64_t header_nanos = StampInHeaders();
  present_.reset();
  if (chained == Result::kNoTree) return chained;
  if (!SetStamp(header_nanos, first_record_nanos_, origin)) return Result::kDuplicate;
  SetSegments(poses);
  root_ = *root;
  sample_.arrival_nanos = arrival_nanos;
  ++samples_;
  return Result::kSample;
}

TransformPerson::Result TransformPerson::Chain(Poses& poses, const std::string*& root) const {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    const FrameTransform* at = Find(segment);
    Pose pose = at->parent_from_child;
    for (int steps = 0; at->parent_slot >= 0; ++steps) {
      if (steps == kFrameSlots) return Result::kNoTree;  // a cycle
      at = Find(at->parent_slot);
      if (at == nullptr) return Result::kNothing;
      const Pose& up = at->parent_from_child;
      pose = {up.position + up.orientation * pose.position, up.orientation * pose.orientation};
    }
    if (root != nullptr && *root != at->parent) return Result::kNoTree;
    root = &at->parent;
    poses[At(segment)] = pose;
  }
  return Result::kSample;
}

// That of the pelvis, unless it is static.
std::int64_t TransformPerson::StampInHeaders() const {
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    if (present_.test(At(segment))) return pending_[At(segment)].header_nanos;
  }
  return 0;
}

bool TransformPerson::SetStamp(std::int64_t header_nanos, std::int64_t record_nanos,
                               SampleOrigin& origin) {
  if (record_nanos < last_record_nanos_) StartOver(header_nanos, record_nanos);
  last_record_nanos_ = record_nanos;
  if (headers_are_right_ && samples_ > 0 && header_nanos == last_header_nanos_) return false;
  headers_are_right_ = headers_are_right_ && IsOfRecordTime(header_nanos, record_nanos) &&
                       (samples_ == 0 || header_nanos > last_header_nanos_);
  if (samples_ > 0 && header_nanos < last_header_nanos_) ++steps_back_;
  last_header_nanos_ = header_nanos;
  std::int64_t stamp = headers_are_right_ ? header_nanos : record_nanos;
  if (samples_ == 0) {
    const bool is_later = origin.stamp_nanos && *origin.stamp_nanos <= stamp;
    first_stamp_ = is_later ? *origin.stamp_nanos : stamp;
    first_counter_ = is_later ? origin.counter : 0;
  } else {
    // Equal record times, and the change from header to record times, must not turn time back.
    stamp = std::max(stamp, sample_.stamp_nanos + kMinStepNanos);
  }
  sample_.counter = first_counter_ + samples_;
  sample_.stamp_nanos = stamp;
  sample_.time_code_millis = (stamp - first_stamp_ + kNanosPerMilli / 2) / kNanosPerMilli;
  origin = {first_stamp_, sample_.counter};
  return true;
}

// After the clock was set back: the time code goes on.
void TransformPerson::StartOver(std::int64_t header_nanos, std::int64_t record_nanos) {
  ++steps_back_;
  headers_are_right_ = true;
  last_header_nanos_ = header_nanos - 1;
  // Headers that are of another time are not taken.
  const std::int64_t earlier = IsOfRecordTime(header_nanos, record_nanos)
                                   ? std::min(header_nanos, record_nanos)
                                   : record_nanos;
  const std::int64_t before = earlier - kMinStepNanos;
  first_stamp_ += before - sample_.stamp_nanos;
  sample_.stamp_nanos = before;
}

void TransformPerson::SetSegments(const Poses& poses) {
  if (!arms_are_turned_) FindArmFrames(poses);
  for (int segment = 0; segment < urdf::kSegmentCount; ++segment) {
    SegmentState& state = sample_.segments[At(segment)];
    Quaterniond orientation = poses[At(segment)].orientation;
    if (arms_are_turned_.value_or(true)) {
      orientation = orientation * urdf::SegmentFromLink(segment).conjugate();
    }
    orientation.normalize();
    // Both signs mean the same rotation; the one nearer to the sample before avoids a jump.
    if (samples_ > 0 && orientation.dot(state.orientation) < 0) orientation.coeffs() *= -1;
    state.orientation = orientation;
    state.position = poses[At(segment)].position;
  }
}

void TransformPerson::FindArmFrames(const Poses& poses) {
  double level = 0;    // as in segment frames
  double hanging = 0;  // as in link frames
  for (const ArmBone& bone : kArmBones) {
    const Pose& from = poses[At(bone.segment)];
    const Vector3d next = poses[At(bone.segment + 1)].position - from.position;
    if (next.norm() < kShortestArmBone) return;  // not a body yet; a later sample decides
    const Vector3d direction = from.orientation.conjugate() * next.normalized();
    level += bone.along_y * direction.y();
    hanging -= direction.z();
  }
  arms_are_turned_ = hanging > level;
}

}  // namespace kinescope::ros_bridge
