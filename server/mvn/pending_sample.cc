#include "server/mvn/pending_sample.h"

#include <algorithm>

#include "server/core/check.h"

namespace kinescope::mvn {
namespace {

template <std::size_t kBits, class Visit>
void ForEachSet(const std::bitset<kBits>& bits, const Visit& visit) {
  for (std::size_t i = 0; i < kBits; ++i) {
    if (bits.test(i)) visit(i);
  }
}

}  // namespace

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

SampleType PendingSample::TypeOf(const Message& message) {
  switch (message.header.type) {
    case Type::kPose: return kPoseType;
    case Type::kJointAngles: return kAnglesType;
    case Type::kLinear: return kLinearType;
    case Type::kAngular: return kAngularType;
    default: break;
  }
  KINESCOPE_CHECK(message.header.type == Type::kCenterOfMass);
  return kComType;
}

bool PendingSample::Has(const Message& message) const {
  return parts_[static_cast<std::size_t>(TypeOf(message))].came.test(
      static_cast<std::size_t>(message.header.part));
}

PendingSample::Added PendingSample::Add(const Message& message, std::int64_t now_nanos) {
  const Header& header = message.header;
  Parts& parts = parts_[static_cast<std::size_t>(TypeOf(message))];
  const auto part = static_cast<std::size_t>(header.part);
  if (parts.came.test(part)) return Added::kDuplicate;
  const bool beyond_the_last = parts.last >= 0 && header.part > parts.last;
  const bool last_before_others = header.is_last_part && (parts.came >> part).any();
  const bool second_last = header.is_last_part && parts.last >= 0;
  if (beyond_the_last || last_before_others || second_last) return Added::kContradiction;
  parts.came.set(part);
  if (header.is_last_part) parts.last = header.part;
  ++datagrams_;
  // Datagrams are stamped by the kernel, yet may be handed over in another order.
  sample_.arrival_nanos = std::max(sample_.arrival_nanos, now_nanos);
  std::visit([this](const auto& body) { Store(body); }, message.body);
  return Added::kYes;
}

void PendingSample::Store(const PoseMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    sample_.segments[i].position = body.items[i].position;
    sample_.segments[i].orientation = body.items[i].orientation;
  });
  posed_ |= body.present;
}

void PendingSample::Store(const LinearMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    linear_position_[i] = body.items[i].position;
    sample_.segments[i].velocity = body.items[i].velocity;
    sample_.segments[i].acceleration = body.items[i].acceleration;
  });
  linear_ |= body.present;
}

void PendingSample::Store(const AngularMessage& body) {
  ForEachSet(body.present, [&](std::size_t i) {
    angular_orientation_[i] = body.items[i].orientation;
    sample_.segments[i].angular_velocity = body.items[i].velocity;
    sample_.segments[i].angular_acceleration = body.items[i].acceleration;
  });
  angular_ |= body.present;
}

void PendingSample::Store(const JointAnglesMessage& body) {
  ForEachSet(body.joints_present, [&](std::size_t i) { angles_[i] = body.joints[i]; });
  angled_ |= body.joints_present;
}

void PendingSample::Store(const CenterOfMassMessage& body) {
  sample_.com = CenterOfMass{body.position, body.velocity, body.acceleration, body.has_derivatives};
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

bool PendingSample::HasPose() const { return posed_.all() || (linear_.all() && angular_.all()); }

BodySample PendingSample::Take() const {
  KINESCOPE_CHECK(HasPose());
  BodySample sample = sample_;
  sample.has_linear = linear_.all();
  sample.has_angular = angular_.all();
  for (std::size_t i = 0; i < sample.segments.size(); ++i) {
    SegmentState& segment = sample.segments[i];
    if (!posed_.all()) {
      segment.position = linear_position_[i];
      segment.orientation = angular_orientation_[i];
    }
    if (!sample.has_linear) {
      segment.velocity = segment.acceleration = Eigen::Vector3d::Zero();
    }
    if (!sample.has_angular) {
      segment.angular_velocity = segment.angular_acceleration = Eigen::Vector3d::Zero();
    }
  }
  if (angled_.all()) sample.streamed_angles_deg = angles_;
  return sample;
}

}  // namespace kinescope::mvn
