#include "server/subject/posture.h"

#include "core/system/check.h"

namespace kinescope::subject {
namespace {

using urdf::Side;

struct LimbTurns {
  JetQuaternion upper;
  JetQuaternion lower;
};

// Two bones along -z whose far end comes to `target`, seen from their root. The middle joint moves
// towards +x (`forward` = 1, a knee) or -x (-1, an elbow), after `swivel` about the line of reach.
LimbTurns Reach(const JetVector& target, double upper_length, double lower_length, double forward,
                const Jet& swivel) {
  const Jet distance = sqrt(target.dot(target));
  KINESCOPE_CHECK(distance.value < upper_length + lower_length);
  const JetVector up = -target / distance;
  const Jet pitch = atan2(up.x(), up.z());
  const Jet roll = atan2(-up.y(), sqrt(up.x() * up.x() + up.z() * up.z()));
  const JetQuaternion along = TurnY(pitch) * TurnX(roll) * TurnZ(swivel);
  // Law of cosines, in the triangle of both bones and the line of reach.
  const double u2 = upper_length * upper_length;
  const double l2 = lower_length * lower_length;
  const Jet d2 = distance * distance;
  const Jet at_root = acos((u2 + d2 - l2) / (2 * upper_length * distance));
  const Jet at_end = acos((l2 + d2 - u2) / (2 * lower_length * distance));
  return {along * TurnY(-forward * at_root), along * TurnY(forward * at_end)};
}

// How far `q` turns about its own z axis (the twist of swing-then-twist).
Jet TwistZ(const JetQuaternion& q) { return 2.0 * atan2(q.z(), q.w()); }

Eigen::Vector3d Values(const JetVector& v) { return {v.x().value, v.y().value, v.z().value}; }
Eigen::Vector3d Rates(const JetVector& v) { return {v.x().rate, v.y().rate, v.z().rate}; }
Eigen::Vector3d Accels(const JetVector& v) { return {v.x().accel, v.y().accel, v.z().accel}; }

// One order of a quaternion jet, as a plain quaternion (unit only for the values).
template <class Part>
Eigen::Quaterniond PartOf(const JetQuaternion& q, Part Jet::*part) {
  return {q.w().*part, q.x().*part, q.y().*part, q.z().*part};
}

}  // namespace

void Posture::PlacePelvis(const JetVector& position, const JetQuaternion& world_from_pelvis) {
  links_[urdf::kPelvis] = {position, world_from_pelvis};
}

JetVector Posture::OriginOf(int segment) const {
  return PointOn(urdf::kSegments[Index(segment)].parent,
                 skeleton_.origin_in_parent[Index(segment)]);
}

JetVector Posture::PointOn(int segment, const Eigen::Vector3d& in_link) const {
  return position(segment) + orientation(segment) * Constant(in_link);
}

void Posture::Orient(int segment, const JetQuaternion& world_from_link) {
  links_[Index(segment)] = {OriginOf(segment), world_from_link};
}

void Posture::Turn(int segment, const JetQuaternion& parent_from_link) {
  const JetQuaternion& parent = orientation(urdf::kSegments[Index(segment)].parent);
  Orient(segment, parent * parent_from_link);
}

void Posture::ReachWithLeg(Side side, const JetVector& ankle, const Jet& heading,
                           const Jet& knee_out) {
  const int thigh = side == urdf::kRight ? urdf::kRightUpperLeg : urdf::kLeftUpperLeg;
  const auto& origins = skeleton_.origin_in_parent;
  const JetQuaternion facing = TurnZ(heading);
  const JetVector to_ankle = facing.conjugate() * JetVector(ankle - OriginOf(thigh));
  const double outwards = side == urdf::kRight ? -1 : 1;
  const LimbTurns turns = Reach(to_ankle, origins[Index(thigh + 1)].norm(),
                                origins[Index(thigh + 2)].norm(), 1.0, outwards * knee_out);
  Orient(thigh, facing * turns.upper);
  Orient(thigh + 1, facing * turns.lower);
}

void Posture::ReachWithArm(Side side, const JetVector& wrist, const JetQuaternion& world_from_hand,
                           const Jet& swivel) {
  const int upper = side == urdf::kRight ? urdf::kRightUpperArm : urdf::kLeftUpperArm;
  const double outwards = side == urdf::kRight ? 1 : -1;
  const auto& origins = skeleton_.origin_in_parent;
  // Seen from the trunk: elbows follow it when it bends.
  const JetQuaternion& trunk = orientation(urdf::kT8);
  const JetVector to_wrist = trunk.conjugate() * JetVector(wrist - OriginOf(upper));
  const LimbTurns turns = Reach(to_wrist, origins[Index(upper + 1)].norm(),
                                origins[Index(upper + 2)].norm(), -1.0, outwards * swivel);
  const JetQuaternion straight = trunk * turns.lower;
  Orient(upper, trunk * turns.upper);
  Orient(upper + 1, straight * TurnZ(TwistZ(straight.conjugate() * world_from_hand)));
  Orient(upper + 2, world_from_hand);
}

void Posture::LookAt(const JetVector& target, double share) {
  const JetQuaternion& trunk = orientation(urdf::kT8);
  const JetVector to_target = trunk.conjugate() * JetVector(target - OriginOf(urdf::kNeck));
  const Jet level = sqrt(to_target.x() * to_target.x() + to_target.y() * to_target.y());
  const Jet yaw = share * atan2(to_target.y(), to_target.x());
  const Jet pitch = share * atan2(-to_target.z(), level);
  constexpr double kNeckShare = 0.45;  // the rest is C1/head
  Turn(urdf::kNeck, TurnZ(kNeckShare * yaw) * TurnY(kNeckShare * pitch));
  Orient(urdf::kHead, trunk * TurnZ(yaw) * TurnY(pitch));
}

BodySample Posture::ToSample(const urdf::BodyParameters& body) const {
  BodySample sample;
  JetVector moment = JetVector::Zero();
  double mass = 0;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    const JetVector& p = position(i);
    const JetQuaternion& q = orientation(i);
    const Eigen::Quaterniond value = PartOf(q, &Jet::value);
    SegmentState& segment = sample.segments[Index(i)];
    segment.position = Values(p);
    segment.velocity = Rates(p);
    segment.acceleration = Accels(p);
    // q' = w q / 2, so w = 2 q' q*; and w' = 2 q'' q* but for a real part.
    segment.angular_velocity = 2 * (PartOf(q, &Jet::rate) * value.conjugate()).vec();
    segment.angular_acceleration = 2 * (PartOf(q, &Jet::accel) * value.conjugate()).vec();
    segment.orientation = (value * urdf::SegmentFromLink(i).conjugate()).normalized();
    moment += PointOn(i, body[Index(i)].com_in_link) * Jet(body[Index(i)].mass);
    mass += body[Index(i)].mass;
  }
  const JetVector com = moment / Jet(mass);
  sample.com = CenterOfMass{Values(com), Rates(com), Accels(com), true};
  sample.has_linear = true;
  sample.has_angular = true;
  sample.streamed_angles_deg =
      urdf::AnatomicalAngles(OrientationsOf(sample), urdf::AngleSequence::kZxy);
  return sample;
}

}  // namespace kinescope::subject
