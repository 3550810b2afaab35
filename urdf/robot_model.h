/// A URDF, read: what it takes to draw a robot, to chain its links and to weigh it. Reading is
/// urdfdom's work; no type of urdfdom shows here. Metres, radians, kilograms; frames as in the URDF
/// specification. Plain values, any thread.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "urdf/urdf_error.h"

namespace kinescope::urdf {

struct Geometry {
  enum class Kind { kBox, kCylinder, kSphere, kMesh };
  Kind kind = Kind::kBox;
  Eigen::Vector3d size = Eigen::Vector3d::Ones();  // box: x y z; cylinder: radius, length, 0;
                                                   // sphere: radius, 0, 0; mesh: its scale
  std::string mesh_uri;                            // as written: package://, file://, a path
};

struct Visual {
  Eigen::Isometry3d link_from_visual = Eigen::Isometry3d::Identity();
  Geometry geometry;
  std::optional<Eigen::Vector4d> rgba;  // 0..1, sRGB; none: the URDF gives no colour
  std::string name;                     // "" when it has none
  std::string material;                 // its name, likewise
};

struct Collision {
  Eigen::Isometry3d link_from_collision = Eigen::Isometry3d::Identity();
  Geometry geometry;
  std::string name;  // "" when it has none
};

struct Inertial {
  double mass = 0;
  Eigen::Isometry3d link_from_inertial = Eigen::Isometry3d::Identity();  // origin: centre of mass
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about it, in the inertial frame, kg m^2
};

struct Link {
  std::string name;
  std::vector<Visual> visuals;
  std::vector<Collision> collisions;
  std::optional<Inertial> inertial;
  double mass = 0;  // of `inertial`; 0 without
};

struct JointLimits {
  double lower = 0;     // rad or m; equal to upper for a continuous joint that gives none
  double upper = 0;     // likewise
  double effort = 0;    // N m or N
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
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();  // in the joint's frame, as long as written
  std::optional<JointLimits> limits;
  std::optional<Mimic> mimic;
  double damping = 0;   // N m s/rad or N s/m
  double friction = 0;  // N m or N

  /// One number says where it is: neither fixed, nor floating, nor planar.
  bool HasPosition() const {
    return type == Type::kRevolute || type == Type::kContinuous || type == Type::kPrismatic;
  }
};

struct RobotModel {
  std::string name;
  std::string root_link;
  std::vector<Link> links;         // the root first, parents before children
  std::vector<RobotJoint> joints;  // likewise
  std::vector<std::string> notes;  // what was read over: textures, floating and planar joints
};

/// What a robot may measure, so that it can be drawn and no number overflows. Beyond it a URDF is
/// refused.
constexpr double kMostMeters = 1000;  // of a shape, and between frames
constexpr double kMostScale = 1e6;    // of a mesh
constexpr std::size_t kMostLinks = 10'000;

/// @throws UrdfError: bytes and nesting are bounded before anything is built from them; whatever
/// urdfdom only grumbles about is an error too, since a robot without its arm is worse than none.
RobotModel ParseUrdf(const std::string& xml);

}  // namespace kinescope::urdf
