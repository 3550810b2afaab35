#include "server/ros/joint_states.h"

#include <cmath>

#include "core/system/check.h"
#include "core/unknown.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

void Put(const Vector3d& xyz, std::size_t row, std::vector<double>& out) {
  for (int axis = 0; axis < 3; ++axis) out[3 * row + At(axis)] = xyz[axis];
}

void FillVelocities(const PersonState& person, std::size_t joints, std::vector<double>& out) {
  out.assign(joints, kUnknown);
  std::size_t row = 0;
  for (const int joint : JointsByName()) {
    const auto parent = At(urdf::ParentOf(joint));
    const auto child = At(urdf::ChildOf(joint));
    const Vector3d in_world = person.sample.segments[child].angular_velocity -
                              person.sample.segments[parent].angular_velocity;
    const Vector3d in_parent = person.links[parent].orientation.conjugate() * in_world;
    Put(AngleRates(person.angles[At(joint)], in_parent), row++, out);
  }
}

void FillEfforts(const PersonState& person, std::size_t joints, std::vector<double>& out) {
  out.clear();
  std::size_t row = 0;
  for (const int joint : JointsByName()) {
    const std::size_t at = row++;
    const JointForce& load = person.forces.joints[At(joint)];
    if (!load.why_unknown.empty() || !load.moment.allFinite()) continue;
    if (out.empty()) out.assign(joints, kUnknown);
    const auto parent = At(urdf::ParentOf(joint));
    const auto child = At(urdf::ChildOf(joint));
    Put(AxisMoments(person.links[parent].orientation, person.links[child].orientation,
                    person.angles[At(joint)].y(), load.moment),
        at, out);
  }
}

void SetNames(const PersonNames& names, sensor_msgs::JointState& message) {
  if (message.name != names.joints) message.name = names.joints;
  message.position.resize(names.joints.size());
}

// Positions of gloves and props, after those of the body: in the order of PersonNames::joints.
void PutExtra(const PersonState& person, std::vector<double>& out) {
  std::size_t row = urdf::kJointCount;
  for (const urdf::Side side : {urdf::kLeft, urdf::kRight}) {
    if (!person.gloves[side]) continue;
    for (const Vector3d& angles : person.gloves[side]->angles) Put(angles, row++, out);
  }
  const urdf::Pose& pelvis = person.links[urdf::kPelvis];
  for (const auto& prop : person.props) {
    if (!prop) continue;
    Put(pelvis.orientation.conjugate() * (prop->pose.position - pelvis.position), row++, out);
    Put({prop->angles.y(), prop->angles.x(), prop->angles.z()}, row++, out);
  }
  KINESCOPE_CHECK(3 * row == out.size());
}

}  // namespace

Vector3d AngleRates(const Vector3d& angles, const Vector3d& rate) {
  // After the rotation about y, the rate is (x', y' - z' sin x, z' cos x).
  const Vector3d turned = Eigen::AngleAxisd(-angles.y(), Vector3d::UnitY()) * rate;
  const double sine = std::sin(angles.x());
  const double cosine = std::cos(angles.x());
  constexpr double kLocked = 1e-3;  // rates would be a thousand times the measured one
  if (std::abs(cosine) < kLocked) {
    return {turned.x(), turned.y() / 2, -sine * turned.y() / 2};
  }
  const double z_rate = turned.z() / cosine;
  return {turned.x(), turned.y() + z_rate * sine, z_rate};
}

Vector3d AxisMoments(const Quaterniond& world_from_parent, const Quaterniond& world_from_child,
                     double y, const Vector3d& moment) {
  const Vector3d x_axis =
      world_from_parent * (Eigen::AngleAxisd(y, Vector3d::UnitY()) * Vector3d::UnitX());
  return {moment.dot(x_axis), moment.dot(world_from_parent * Vector3d::UnitY()),
          moment.dot(world_from_child * Vector3d::UnitZ())};  // the last one keeps its own axis
}

Vector3d SeedAngles(int joint, const Vector3d& streamed_deg) {
  using namespace urdf;
  // MVN's signs follow anatomy (away from the body, inwards, flexion); here signs follow the axes.
  Vector3d sign(1, 1, 1);  // signs of MVN's x, y, z: spine, neck and head
  const bool is_left = joint == jLeftC7Shoulder || joint == jLeftShoulder || joint == jLeftElbow ||
                       joint == jLeftWrist || joint >= jLeftHip;
  const bool is_knee = joint == jRightKnee || joint == jLeftKnee;
  if (joint > jC1Head) {
    sign = {is_left ? 1.0 : -1.0, is_left ? -1.0 : 1.0, is_knee ? 1.0 : -1.0};
  }
  const Vector3d streamed = streamed_deg * (M_PI / 180);
  Vector3d angles(sign.x() * streamed.x(), sign.z() * streamed.z(), sign.y() * streamed.y());
  // MVN's forearm angle is 0 with the palm forward, that of the link frame in the N-pose.
  if (joint == jRightElbow) angles.z() -= M_PI_2;
  if (joint == jLeftElbow) angles.z() += M_PI_2;
  return angles;
}

void FillComputedJointStates(const PersonState& person, const PersonNames& names,
                             sensor_msgs::JointState& message) {
  message.header.stamp = StampOf(person.sample);
  SetNames(names, message);
  std::size_t row = 0;
  for (const int joint : JointsByName()) Put(person.angles[At(joint)], row++, message.position);
  PutExtra(person, message.position);
  message.velocity.clear();
  if (person.sample.has_angular) FillVelocities(person, message.name.size(), message.velocity);
  FillEfforts(person, message.name.size(), message.effort);
}

bool FillStreamedJointStates(const PersonState& person, const PersonNames& names,
                             sensor_msgs::JointState& message) {
  if (!person.sample.streamed_angles_deg) return false;
  message.header.stamp = StampOf(person.sample);
  SetNames(names, message);
  std::size_t row = 0;
  for (const int joint : JointsByName()) {
    Put(SeedAngles(joint, (*person.sample.streamed_angles_deg)[At(joint)]), row++,
        message.position);
  }
  PutExtra(person, message.position);
  message.velocity.clear();
  message.effort.clear();
  return true;
}

}  // namespace kinescope::ros_bridge
