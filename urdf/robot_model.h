/// A URDF, read: what it takes to draw it and to chain its links. Reading is urdfdom's work; no
/// type of urdfdom shows here. Metres, radians, kilograms; frames as in the URDF specification.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace kinescope::urdf {

/// The text is no usable URDF; what() says which element is wrong and why.
class UrdfError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

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
};

struct Link {
  std::string name;
  std::vector<Visual> visuals;
  double mass = 0;
};

struct RobotJoint {
  enum class Type { kFixed, kRevolute, kContinuous, kPrismatic, kOther };
  std::string name;
  Type type = Type::kFixed;
  std::string parent_link;
  std::string child_link;
  Eigen::Isometry3d parent_from_joint = Eigen::Isometry3d::Identity();  // at position 0
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();                      // in the joint's frame
};

struct RobotModel {
  std::string name;
  std::string root_link;
  std::vector<Link> links;
  std::vector<RobotJoint> joints;  // parents before children
};

/// @throws UrdfError.
RobotModel ParseUrdf(const std::string& xml);

}  // namespace kinescope::urdf
