#include "urdf/robot/robot_kinematics.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "urdf/robot/robot_model.h"

namespace kinescope::urdf {
namespace {

using Eigen::Isometry3d;

using JointIndex = std::unordered_map<std::string, const RobotJoint*>;

double Rest(const RobotJoint& joint) {
  const bool is_bounded = joint.type != RobotJoint::Type::kContinuous && joint.limits &&
                          joint.limits->lower <= joint.limits->upper;
  return is_bounded ? std::clamp(0.0, joint.limits->lower, joint.limits->upper) : 0.0;
}

// What multipliers of a hostile document lead to is no place.
constexpr double kMaxPosition = 1e6;
constexpr int kMaxMimics = 100;  // in a row; more is a ring, or no mechanism

double Follow(const RobotJoint& joint, const JointPositions& given, const JointIndex& joints) {
  double multiplier = 1, offset = 0;
  const RobotJoint* at = &joint;
  for (int hops = 0; hops < kMaxMimics; ++hops) {
    const auto own = given.find(at->name);
    if (own != given.end()) return multiplier * own->second + offset;
    if (!at->mimic) return multiplier * Rest(*at) + offset;
    const auto next = joints.find(at->mimic->joint);
    if (next == joints.end()) break;
    offset += multiplier * at->mimic->offset;
    multiplier *= at->mimic->multiplier;
    at = next->second;
  }
  return Rest(joint);
}

double PositionOf(const RobotJoint& joint, const JointPositions& given, const JointIndex& joints) {
  const double position = Follow(joint, given, joints);
  return std::abs(position) <= kMaxPosition ? position : 0;  // not for NaN either
}

Isometry3d Motion(const RobotJoint& joint, double position) {
  Isometry3d motion = Isometry3d::Identity();
  const Eigen::Vector3d axis = joint.axis.normalized();
  if (joint.type == RobotJoint::Type::kPrismatic) {
    motion.translation() = position * axis;
  } else {
    motion.linear() = Eigen::AngleAxisd(position, axis).toRotationMatrix();
  }
  return motion;
}

}  // namespace

std::vector<Isometry3d> PlaceLinks(const RobotModel& robot, const JointPositions& positions,
                                   const Isometry3d& world_from_root) {
  JointIndex joints;
  for (const RobotJoint& joint : robot.joints) joints[joint.name] = &joint;
  for (const auto& [name, position] : positions) {
    const auto joint = joints.find(name);
    if (joint == joints.end()) throw UrdfError("unknown joint '" + name + "'");
    if (!joint->second->HasPosition()) {
      throw UrdfError("joint '" + name + "' has no position: it is fixed, floating or planar");
    }
  }
  std::unordered_map<std::string, std::size_t> links;
  for (std::size_t i = 0; i < robot.links.size(); ++i) links[robot.links[i].name] = i;

  std::vector<Isometry3d> placed(robot.links.size(), Isometry3d::Identity());
  if (!placed.empty()) placed[links.at(robot.root_link)] = world_from_root;
  for (const RobotJoint& joint : robot.joints) {  // parents before children
    Isometry3d& child = placed[links.at(joint.child_link)];
    child = placed[links.at(joint.parent_link)] * joint.parent_from_joint;
    if (joint.HasPosition()) child = child * Motion(joint, PositionOf(joint, positions, joints));
  }
  return placed;
}

}  // namespace kinescope::urdf
