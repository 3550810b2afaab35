#include "server/ros/force_input.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "server/ros/joint_loads.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMaxForce = 20'000;      // N, ten times what landing from a jump takes
constexpr double kMaxMoment = 20'000;     // N·m
constexpr double kReach = 2;              // m
constexpr double kMinGroundForce = 20;    // N; below it, a plate's CoP is noise
constexpr std::size_t kMaxJoints = 1000;  // per message; a person has 66

tl::unexpected<Refusal> NoForce(const char* kind, std::string text) {
  return tl::unexpected(Refusal{kind, std::move(text)});
}

template <class RosVector>
Vector3d FromForce(const RosVector& v) {
  return {v.x, v.y, v.z};
}

struct WorldWrench {
  Vector3d force, moment;  // about the frame's origin
};

Taken<WorldWrench> ToWorld(const geometry_msgs::WrenchStamped& message, const FoundFrame& frame) {
  const Vector3d force = FromForce(message.wrench.force), moment = FromForce(message.wrench.torque);
  if (!force.allFinite() || !moment.allFinite()) {
    return NoForce("not a number", "a force or moment is not a number");
  }
  if (force.norm() > kMaxForce || moment.norm() > kMaxMoment) {
    return NoForce(
        "too large",
        fmt::format(
            "{:.3g} N, {:.3g} N·m: expected at most {:.0f} N and {:.0f} N·m; check the unit",
            force.norm(), moment.norm(), kMaxForce, kMaxMoment));
  }
  return WorldWrench{frame.pose.orientation * force, frame.pose.orientation * moment};
}

double HorizontalDistance(const Vector3d& a, const Vector3d& b) { return (a - b).head<2>().norm(); }

// Axes of a joint's three rotations, as rows: x, y, z.
Taken<Matrix3d> AxesOf(int joint, bool is_rot, const BodyNow& body) {
  const int parent = urdf::ParentOf(joint), child = urdf::ChildOf(joint);
  Quaterniond world_from_parent = body.links[At(parent)].orientation;
  Quaterniond world_from_child = body.links[At(child)].orientation;
  Matrix3d axes;
  if (is_rot) {  // x, y, z between segment frames
    world_from_parent = world_from_parent * urdf::SegmentFromLink(parent).conjugate();
    world_from_child = world_from_child * urdf::SegmentFromLink(child).conjugate();
    const Matrix3d turn = (world_from_parent.conjugate() * world_from_child).toRotationMatrix();
    const double x = std::atan2(-turn(1, 2), turn(2, 2));
    axes.row(0) = world_from_parent * Vector3d::UnitX();
    axes.row(1) = world_from_parent * (Eigen::AngleAxisd(x, Vector3d::UnitX()) * Vector3d::UnitY());
  } else {
    const Vector3d angles =
        urdf::AnglesFromRotation(world_from_parent.conjugate() * world_from_child);
    axes.row(0) =
        world_from_parent * (Eigen::AngleAxisd(angles.y(), Vector3d::UnitY()) * Vector3d::UnitX());
    axes.row(1) = world_from_parent * Vector3d::UnitY();
  }
  axes.row(2) = world_from_child * Vector3d::UnitZ();
  constexpr double kLocked = 0.05;  // three axes nearly in a plane do not determine a moment
  if (std::abs(axes.determinant()) < kLocked) {
    return NoForce("axes fall together",
                   fmt::format("{}: its three axes lie in one plane in this pose",
                               urdf::kJoints[At(joint)].mvn_name));
  }
  return axes;
}

// The values of a message of joints, by joint.
struct Efforts {
  std::array<Vector3d, urdf::kJointCount> about_axes;
  std::array<bool, urdf::kJointCount> is_given{}, is_rot{};
};

Taken<ExternalLoads> FromEfforts(const sensor_msgs::JointState& message, const BodyNow& body,
                                 double scale) {
  ExternalLoads loads;
  Efforts efforts;
  efforts.about_axes.fill(Vector3d::Zero());
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    const NamedJoint named = FindNamedJoint(message.name[i]);
    if (named.joint < 0 || named.axis < 0) {
      ++loads.unknown_joints;
      continue;
    }
    const std::size_t joint = At(named.joint);
    efforts.about_axes[joint][named.axis] = scale * message.effort[i];  // NaN: stays unknown
    efforts.is_given[joint] = true;
    efforts.is_rot[joint] = named.is_rot;
  }
  for (int joint = 0; joint < urdf::kJointCount; ++joint) {
    const Vector3d& about_axes = efforts.about_axes[At(joint)];
    if (!efforts.is_given[At(joint)] || !about_axes.allFinite()) continue;
    const auto axes = AxesOf(joint, efforts.is_rot[At(joint)], body);
    if (!axes) continue;  // only this joint; it expires
    loads.joints[At(joint)].moment = axes->inverse() * about_axes;
    loads.is_given[At(joint)] = true;
  }
  return loads;
}

Taken<ExternalLoads> FromRatios(const sensor_msgs::JointState& message) {
  ExternalLoads loads;
  for (std::size_t i = 0; i < message.name.size(); ++i) {
    const NamedJoint named = FindNamedJoint(message.name[i]);
    if (named.joint < 0) {
      ++loads.unknown_joints;
    } else if (named.axis >= 0) {
      return NoForce("no effort",
                     "'" + message.name[i] + "': expected efforts, or ratios of whole joints");
    } else if (const double ratio = message.position[i]; ratio >= 0) {
      loads.joints[At(named.joint)].ratio = ratio;
      loads.is_given[At(named.joint)] = true;
    }
  }
  return loads;
}

}  // namespace

Taken<MeasuredGroundForce> ToGroundForce(const geometry_msgs::WrenchStamped& message,
                                         const FoundFrame& frame, const BodyNow& body) {
  const auto wrench = ToWorld(message, frame);
  if (!wrench) return tl::unexpected(wrench.error());
  const Vector3d& force = wrench->force;
  const Vector3d& origin = frame.pose.position;
  MeasuredGroundForce ground;
  ground.only_vertical = message.wrench.force.x == 0 && message.wrench.force.y == 0;
  if (force.z() < -kMinGroundForce) {
    return NoForce("pushes down",
                   fmt::format("the force points down ({:.0f} N); expected the ground reaction "
                               "force on the person, which points up; invert the sign",
                               -force.z()));
  }
  if (force.z() < kMinGroundForce) {
    ground.point = {origin.x(), origin.y(), body.floor_z};
    return ground;
  }
  ground.force = force;
  const double up = body.floor_z - origin.z();
  const Vector3d arm((up * force.x() - wrench->moment.y()) / force.z(),
                     (up * force.y() + wrench->moment.x()) / force.z(), up);
  ground.point = origin + arm;
  ground.free_moment = wrench->moment.z() - (arm.x() * force.y() - arm.y() * force.x());
  const double away = HorizontalDistance(ground.point, body.links[urdf::kPelvis].position);
  if (!(away < kReach)) {
    return NoForce(
        "far away",
        fmt::format("its centre of pressure is {:.1f} m from the pelvis; expected less than {} m",
                    away, kReach));
  }
  return ground;
}

Taken<Vector3d> ToCop(const geometry_msgs::PointStamped& message, const FoundFrame& frame,
                      const BodyNow& body) {
  Vector3d point = frame.pose.position + frame.pose.orientation * FromForce(message.point);
  if (!point.allFinite()) return NoForce("not a number", "a coordinate is not a number");
  point.z() = body.floor_z;
  const double away = HorizontalDistance(point, body.links[urdf::kPelvis].position);
  if (!(away < kReach)) {
    return NoForce(
        "far away",
        fmt::format("the centre of pressure is {:.1f} m from the pelvis; expected less than {} m",
                    away, kReach));
  }
  return point;
}

Taken<MeasuredHandForce> ToHandForce(const geometry_msgs::WrenchStamped& message,
                                     const FoundFrame& frame, urdf::Side side,
                                     const BodyNow& body) {
  const auto wrench = ToWorld(message, frame);
  if (!wrench) return tl::unexpected(wrench.error());
  MeasuredHandForce hand;
  hand.force = wrench->force;
  hand.moment = wrench->moment;
  if (frame.is_own) return hand;
  hand.point = frame.pose.position;
  const int segment = urdf::HandSegmentOf(side);
  const double away = (*hand.point - body.links[At(segment)].position).norm();
  if (!(away < kReach)) {
    return NoForce(
        "far away",
        fmt::format("its frame is {:.1f} m from the hand; expected less than {} m", away, kReach));
  }
  return hand;
}

Taken<ExternalLoads> ToExternalLoads(const kinescope_ros::JointLoadArray& message,
                                     const FoundFrame& frame, double scale) {
  if (message.loads.size() > kMaxJoints) {
    return NoForce("too many joints",
                   fmt::format("{} joints: expected at most {}", message.loads.size(), kMaxJoints));
  }
  ExternalLoads loads;
  for (const kinescope_ros::JointLoad& given : message.loads) {
    const NamedJoint named = FindNamedJoint(given.joint);
    if (named.joint < 0) {
      ++loads.unknown_joints;
      continue;
    }
    ExternalJointLoad& load = loads.joints[At(named.joint)];
    load.moment = frame.pose.orientation *
                  (scale * Vector3d(given.moment[0], given.moment[1], given.moment[2]));
    load.ratio = given.ratio;
    const bool has_class = given.load_class >= kinescope_ros::JointLoad::LOW &&
                           given.load_class <= kinescope_ros::JointLoad::HIGH;
    load.load_class = has_class ? static_cast<LoadClass>(given.load_class) : LoadClass::kUnknown;
    loads.is_given[At(named.joint)] = has_class || given.ratio >= 0 || load.moment.allFinite();
  }
  return loads;
}

Taken<ExternalLoads> ToExternalLoads(const sensor_msgs::JointState& message, const BodyNow& body,
                                     double scale) {
  const std::size_t count = message.name.size();
  if (count > kMaxJoints) {
    return NoForce("too many joints",
                   fmt::format("{} joints: expected at most {}", count, kMaxJoints));
  }
  for (const auto* values : {&message.position, &message.velocity, &message.effort}) {
    if (!values->empty() && values->size() != count) {
      return NoForce("unequal lengths",
                     fmt::format("{} names and {} values: expected the same number of each", count,
                                 values->size()));
    }
  }
  if (!message.effort.empty()) return FromEfforts(message, body, scale);
  if (!message.position.empty()) return FromRatios(message);
  return NoForce("no effort", "expected efforts or ratios");
}

}  // namespace kinescope::ros_bridge
