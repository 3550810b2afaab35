#include "server/mvn/pending_sample.h"

#include <algorithm>

#include "core/system/check.h"

namespace kinescope::mvn {
namespace {

// More objects than any observed group of tracked objects; a body with more segments than this has
// lost parts.
constexpr int kMaxUnannouncedObjects = 8;

template <std::size_t kBits, class Visit>
void ForEachSet(const std::bitset<kBits>& bits, const Visit& visit) {
  for (std::size_t i = 0; i < kBits; ++i) {
    if (bits.test(i)) visit(i);
  }
}

}  // namespace

std::optional<SampleType> SampleTypeOf(Type type) {
  switch (type) {
    case Type::kEulerPose: return kEulerType;
    case Type::kPose: return kPoseType;
    case Type::kMarkers: return kMarkersType;
    case Type::kJointAngles: return kAnglesType;
    case Type::kLinear: return kLinearType;
    case Type::kAngular: return kAngularType;
    case Type::kTrackers: return kTrackersType;
    case Type::kCenterOfMass: return kComType;
    case Type::kTimeCode: return kTimeCodeType;
    case Type::kMetaData:
    case Type::kScale: break;
  }
  return std::nullopt;
}

bool PendingSample::Parts::whole() const {
  if (last < 0) return false;
  for (int part = 0; part <= last; ++part) {
    if (!came.test(static_cast<std::size_t>(part))) return false;
  }
  return true;
}

void PendingSample::Begin(const Header& header, const Arrival& arrival) {
  *this = PendingSample();
  sample_.counter = header.sample_counter;
  sample_.time_code_millis = header.time_code_millis;
  first_arrival_ = arrival;
}

PendingSample::Added PendingSample::Add(const Message& message, std::uint32_t digest,
                                        std::int64_t now_nanos) {
  const Header& header = message.header;
  const auto type = SampleTypeOf(header.type);
  KINESCOPE_CHECK(type.has_value());
  const auto index = static_cast<std::size_t>(*type);
  Parts& parts = parts_[index];
  const auto part = static_cast<std::size_t>(header.part);
  if (parts.came.test(part)) {
    return part > 0 || digests_[index] == digest ? Added::kDuplicate : Added::kOther;
  }
  const bool beyond_the_last = parts.last >= 0 && header.part > parts.last;
  const bool last_before_others = header.is_last_part && (parts.came >> part).any();
  const bool second_last = header.is_last_part && parts.last >= 0;
  if (beyond_the_last || last_before_others || second_last) return Added::kContradiction;
  parts.came.set(part);
  if (header.is_last_part) parts.last = header.part;
  if (part == 0) digests_[index] = digest;
  if (*type == kPoseType) body_segments_ = header.body_segments;
  ++datagrams_;
  // The kernel stamps datagrams, but may deliver them in another order.
  sample_.arrival_nanos = std::max(sample_.arrival_nanos, now_nanos);
  std::visit([this](const auto& body) { Store(body); }, message.body);
  return Added::kYes;
}

void PendingSample::Store(const PoseMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    poses_[i] = {body.items[i].position, body.items[i].orientation};
  });
  posed_ |= body.present;
  mismatched_ids_ += body.mismatched_ids;
}

void PendingSample::Store(const EulerPoseMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    euler_poses_[i] = {body.items[i].position, body.items[i].orientation};
  });
  euler_posed_ |= body.present;
  mismatched_ids_ += body.mismatched_ids;
}

void PendingSample::Store(const LinearMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    derived_poses_[i].position = body.items[i].position;
    if (i >= sample_.segments.size()) return;
    sample_.segments[i].velocity = body.items[i].velocity;
    sample_.segments[i].acceleration = body.items[i].acceleration;
  });
  linear_ |= body.present;
}

void PendingSample::Store(const AngularMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    derived_poses_[i].orientation = body.items[i].orientation;
    if (i >= sample_.segments.size()) return;
    sample_.segments[i].angular_velocity = body.items[i].velocity;
    sample_.segments[i].angular_acceleration = body.items[i].acceleration;
  });
  angular_ |= body.present;
}

void PendingSample::Store(const JointAnglesMessage& body) {
  ForEachSet(body.joints_present, [&](std::size_t i) { angles_[i] = body.joints[i]; });
  angled_ |= body.joints_present;
}

void PendingSample::Store(const TrackersMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) { sample_.trackers[i] = body.trackers[i]; });
  sample_.has_tracker |= body.present;
}

void PendingSample::Store(const CenterOfMassMessage& body) {
  sample_.com = CenterOfMass{body.position, body.velocity, body.acceleration, body.has_derivatives};
}

void PendingSample::Store(const TimeCodeMessage& body) {
  sample_.utc_millis_of_day = body.utc_millis_of_day;
}

SampleTypes PendingSample::begun() const {
  SampleTypes types;
  for (std::size_t i = 0; i < parts_.size(); ++i) types.set(i, parts_[i].came.any());
  return types;
}

SampleTypes PendingSample::whole() const {
  SampleTypes types;
  for (std::size_t i = 0; i < parts_.size(); ++i) types.set(i, parts_[i].whole());
  return types;
}

bool PendingSample::IsBody(const Slots& slots) {
  for (std::size_t i = 0; i < urdf::kSegmentCount; ++i) {
    if (!slots.test(i)) return false;
  }
  return true;
}

bool PendingSample::HasPose() const {
  return IsBody(posed_) || IsBody(linear_ & angular_) || IsBody(euler_posed_);
}

bool PendingSample::HasObjects() const {
  if (!IsWhole(kPoseType) || IsBody(posed_) || posed_.none()) return false;
  const auto count = static_cast<int>(posed_.count());
  if (body_segments_ == urdf::kSegmentCount) return false;  // a body with parts missing
  const bool announced = body_segments_ == count;
  return announced || (body_segments_ == 0 && count <= kMaxUnannouncedObjects);
}

BodySample PendingSample::TakeBody() const {
  KINESCOPE_CHECK(HasPose());
  BodySample sample = sample_;
  sample.has_linear = IsBody(linear_);
  sample.has_angular = IsBody(angular_);
  // The quaternions of 02 are exact; 21 and 22 repeat them, and those of 01 were converted from
  // angles.
  const Slots derived = linear_ & angular_;
  const Slots& slots = IsBody(posed_) ? posed_ : IsBody(derived) ? derived : euler_posed_;
  const auto& poses = IsBody(posed_) ? poses_ : IsBody(derived) ? derived_poses_ : euler_poses_;
  for (std::size_t i = 0; i < sample.segments.size(); ++i) {
    SegmentState& segment = sample.segments[i];
    segment.position = poses[i].position;
    segment.orientation = poses[i].orientation;
    if (!sample.has_linear) {
      segment.velocity = segment.acceleration = Eigen::Vector3d::Zero();
    }
    if (!sample.has_angular) {
      segment.angular_velocity = segment.angular_acceleration = Eigen::Vector3d::Zero();
    }
  }
  for (std::size_t i = 0; i < kFingerAndPropCount; ++i) {
    const std::size_t slot = urdf::kSegmentCount + i;
    sample.fingers_and_props.present.set(i, slots.test(slot));
    if (slots.test(slot)) sample.fingers_and_props.poses[i] = poses[slot];
  }
  if (angled_.all()) sample.streamed_angles_deg = angles_;
  return sample;
}

ObjectsSample PendingSample::TakeObjects() const {
  KINESCOPE_CHECK(HasObjects());
  ObjectsSample sample;
  sample.counter = sample_.counter;
  sample.time_code_millis = sample_.time_code_millis;
  sample.arrival_nanos = sample_.arrival_nanos;
  for (std::size_t i = 0; i < sample.poses.size(); ++i) {
    sample.present.set(i, posed_.test(i));
    sample.poses[i] = poses_[i];
  }
  return sample;
}

}  // namespace kinescope::mvn
