/// Writes the URDF of a person: 23 links, 66 revolute joints (44 more links without mass between
/// them), visuals and inertials. Link and joint names are the seed bridge's with a prefix,
/// `<model>_right_elbow_x`; the chain at each joint is y, then x, then z (kinematics.h).
#pragma once

#include <string>

#include "urdf/body_parameters.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

struct HumanModel {
  std::string model_name = "skeleton";  // prefix of links and joints, name of the robot
  Skeleton skeleton;
  BodyParameters body;
  std::string mesh_folder;  // absolute; holds <link>.stl (figure_files.h). "": primitives instead
};

/// `<model>_<link>`, such as "skeleton_right_forearm".
std::string LinkName(const std::string& model_name, int segment);
/// `<model>_<joint>_<axis>`, axis 0 1 2 = x y z, such as "skeleton_right_elbow_y".
std::string JointName(const std::string& model_name, int joint, int axis);

/// The whole document. Valid for urdfdom, robot_state_publisher and RViz.
std::string WriteUrdf(const HumanModel& human);

}  // namespace kinescope::urdf
