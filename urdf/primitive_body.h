/// Builds the human from boxes, cylinders and spheres: collision shapes of the URDF, and its
/// visuals where no meshes are wanted (RViz on a slow machine). Link frames, metres. Pure
/// functions, any thread.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "urdf/skeleton.h"

namespace kinescope::urdf {

struct Primitive {
  enum class Kind { kBox, kCylinder, kSphere };
  Kind kind = Kind::kBox;
  Eigen::Vector3d size =
      Eigen::Vector3d::Ones();  // m; box: x y z; cylinder: radius, length; sphere: radius
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  // in the link frame, m
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();     // fixed-axis roll, pitch, yaw as in URDF, rad
};

/// The primitives of one segment; at least one.
std::vector<Primitive> PrimitiveBody(const Skeleton& skeleton, int segment);

}  // namespace kinescope::urdf
