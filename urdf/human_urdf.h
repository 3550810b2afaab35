/// Writes the URDF of a person: 23 links, 66 revolute joints (with 44 massless links between them),
/// visuals, collision shapes, inertials and limits. Link and joint names are those of xsens_mvn_ros
/// with a prefix, `<model>_right_elbow_x`. The chain at each joint is y, then x, then z
/// (kinematics.h). Numbers are written with all digits, so that reading them gives the same body.
/// Pure functions, any thread.
///
/// Gloves add 20 links per hand with the same chain (hand.h). They are shown in place of the hand,
/// whose own link keeps its mass. A prop moves freely, which in URDF would be a `floating` joint;
/// but robot_state_publisher and KDL treat such a joint as fixed. So a prop is a child of the
/// pelvis through three prismatic joints (x, y, z) and three revolute ones (y, x, z), which every
/// URDF reader supports. Finger links and props are massless, because their masses are unknown.
///
/// The links inside the joints are massless. KDL, RViz and robot_state_publisher accept this: the
/// mass matrix of a chain is regular if all end links have mass. Sums over links stay those of the
/// body. Gazebo does not accept it: its converter drops a moving link without inertia and all its
/// children, which is everything but the pelvis. `mass_inside_joints` is the setting for Gazebo.
#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <string>
#include <string_view>

#include "urdf/body_parameters.h"
#include "urdf/hand.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

inline constexpr int kMaxProps = 4;

/// Part of a comment at the beginning of each URDF that is written here.
inline constexpr char kWrittenByKinescope[] = "written by Kinescope";
/// Whether `urdf` is a person of a Kinescope, as its beginning says.
bool IsWrittenByKinescope(std::string_view urdf);

struct HumanModel {
  std::string model_name = "skeleton";  // prefix of link and joint names, name of the robot
  Skeleton skeleton;
  BodyParameters body;
  /// Absolute path, package://name/folder or http://host:port/folder. Contains <link>.stl of every
  /// visible link except props (server/body/body_meshes.h). "": primitives instead.
  std::string mesh_folder;
  std::bitset<2> tools;     // by Side: the link of that hand also shows <ToolFileName>.stl
  std::string tool_folder;  // as mesh_folder
  std::array<std::optional<HandSkeleton>, 2> gloves;  // by Side; present where fingers are streamed
  std::bitset<kMaxProps> props;                       // those that are streamed
  /// Gives every link a mass, for Gazebo. Each of the two links inside a joint gets a hundredth of
  /// its segment's mass and inertia, which is subtracted from the segment's own link. The sum does
  /// not change, and the dynamics change little in any pose. The mass of the fingers is taken from
  /// the hand (44 % of it), that of a prop from the pelvis (1.5 % each), so that the total stays
  /// the body mass.
  bool mass_inside_joints = false;
  std::array<double, 3> body_rgb = {0.78, 0.80, 0.84};  // sRGB, 0..1
};

/// Material of a tool's visual.
inline constexpr const char* kToolMaterial = "tool";

/// `<model>_<link>`, such as "skeleton_right_forearm".
std::string LinkName(const std::string& model_name, int segment);
/// `<model>_<joint>_<axis>`, axis 0 1 2 = x y z, such as "skeleton_right_elbow_y".
std::string JointName(const std::string& model_name, int joint, int axis);

/// "left_second_mp": name of its mesh file, without extension.
std::string FingerFileName(Side side, int finger);

/// "right_tool": name of its mesh file, without extension. The mesh is in the hand's link frame.
std::string ToolFileName(Side side);

/// "skeleton_left_second_mp"; its joints are `<that>_x`, `_y`, `_z`.
std::string FingerLinkName(const std::string& model_name, Side side, int finger);
std::string FingerJointName(const std::string& model_name, Side side, int finger, int axis);

/// "skeleton_prop1" for prop 0; its joints in the order of their chain: `_tx _ty _tz _y _x _z`.
std::string PropLinkName(const std::string& model_name, int prop);
std::array<std::string, 6> PropJointNames(const std::string& model_name, int prop);

/// The massless link behind a joint that is not the last of its chain.
std::string LinkInside(const std::string& joint_name);

/// Writes the whole document. Valid for urdfdom, robot_state_publisher and RViz.
std::string WriteUrdf(const HumanModel& human);

}  // namespace kinescope::urdf
