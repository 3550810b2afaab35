/// Reads a URDF into plain data: shapes for rendering, the joint chain and masses. urdfdom does the
/// parsing; none of its types appear here. Metres, radians, kilograms; frames as in the URDF
/// specification. Plain values, any thread.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "urdf/robot/urdf_error.h"

namespace kinescope::urdf {

struct Geometry {
  enum class Kind { kBox, kCylinder, kSphere, kMesh };
  Kind kind = Kind::kBox;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // box: x y z; cylinder: radius, length, 0;
                                                   // sphere: radius, 0, 0; mesh: its scale
  std::string mesh_uri;                            // as in the URDF: package://, file://, a path
};

struct Visual {
  Eigen::Isometry3d link_from_visual = Eigen::Isometry3d::Identity();
  Geometry geometry;
  std::optional<Eigen::Vector4d> rgba;  // 0..1, sRGB; absent: the URDF gives no colour
  double opacity = 1;                   // 0..1, a factor for all of its colours
  std::string name;                     // "" if it has none
  std::string material;                 // name of the material; "" if it has none
};

struct Collision {
  Eigen::Isometry3d link_from_collision = Eigen::Isometry3d::Identity();
  Geometry geometry;
  std::string name;  // "" if it has none
};

struct Inertial {
  double mass = 0;
  Eigen::Isometry3d link_from_inertial = Eigen::Isometry3d::Identity();  // origin: centre of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the centre of mass, in the inertial
                                                      // frame, kg m^2
};

struct Link {
  std::string name;
  std::vector<Visual> visuals;
  std::vector<Collision> collisions;
  std::optional<Inertial> inertial;
  double mass = 0;  // kg, that of `inertial`; 0 without it
};

struct JointLimits {
  double lower = 0;     // rad or m; equal to upper for a continuous joint without limits
  double upper = 0;     // rad or m
  double effort = 0;    // N·m or N
  double velocity = 0;  // rad/s or m/s
};

/// Position = multiplier * (position of `joint`) + offset.
struct Mimic {
  std::string joint;
  double multiplier = 1;
  double offset = 0;
};

struct RobotJoint {
  enum class Type { kFixed, kRevolute, kContinuous, kPrismatic, kFloating, kPlanar };
  std::string name;
  Type type = Type::kFixed;
  std::string parent_link;
  std::string child_link;
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();  // at position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // in the joint's frame, not normalised
  std::optional<JointLimits> limits;
  std::optional<Mimic> mimic;
  double damping = 0;   // N·m·s/rad or N·s/m
  double friction = 0;  // N·m or N

  /// Whether one number is its position: true unless fixed, floating or planar.
  bool HasPosition() const {
    return type == Type::kRevolute || type == Type::kContinuous || type == Type::kPrismatic;
  }
};

struct RobotModel {
  std::string name;
  std::string root_link;
  std::vector<Link> links;         // the root first, parents before children
  std::vector<RobotJoint> joints;  // those of parents before those of children
  std::vector<std::string> notes;  // parts of the URDF that are not used: textures, floating and
                                   // planar joints
};

/// `model`, its visuals as opaque as before times `opacity` (0..1).
RobotModel Translucent(RobotModel model, double opacity);

/// Limits of a robot, so that it can be rendered and no number overflows. A URDF beyond them is
/// rejected.
constexpr double kMaxMeters = 1000;  // largest shape, largest distance between frames
constexpr double kMaxScale = 1e6;    // largest scale of a mesh
constexpr std::size_t kMaxLinks = 10'000;

/// @throws UrdfError. The size and the nesting are checked before anything is built. Problems that
/// urdfdom only logs are errors here, because an incomplete robot is worse than none.
RobotModel ParseUrdf(const std::string& xml);

}  // namespace kinescope::urdf
