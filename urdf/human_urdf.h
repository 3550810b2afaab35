/// Writes the URDF of a person: 23 links, 66 revolute joints (44 more links without mass between
/// them), visuals, collision shapes, inertials and limits. Link and joint names are the seed
/// bridge's with a prefix, `<model>_right_elbow_x`; the chain at each joint is y, then x, then z
/// (kinematics.h). Numbers are written with all their digits: what is read back is the same body.
///
/// Gloves add 20 links a hand, chained likewise (hand.h); they are drawn in place of the hand,
/// whose own link keeps its mass. A prop moves freely, which URDF would call a `floating` joint;
/// robot_state_publisher and KDL hold such a joint for a fixed one. So it hangs on the pelvis by
/// three prismatic joints (x, y, z) and three revolute ones (y, x, z), which every reader takes.
/// Neither weighs anything: nobody says how heavy they are.
///
/// The links inside the joints have no mass. KDL, RViz and robot_state_publisher take them so (a
/// chain of bodies whose tips all have mass has a regular mass matrix), and sums over links stay
/// those of the body. Gazebo does not: its converter leaves out a moving link without inertia and
/// all that hangs on it, which is everything but the pelvis. `mass_inside_joints` is for it.
#pragma once

#include <array>
#include <bitset>
#include <optional>
#include <string>

#include "urdf/body_parameters.h"
#include "urdf/hand.h"
#include "urdf/skeleton.h"

namespace kinescope::urdf {

inline constexpr int kMostProps = 4;

struct HumanModel {
  std::string model_name = "skeleton";  // prefix of links and joints, name of the robot
  Skeleton skeleton;
  BodyParameters body;
  /// Absolute, or package://name/folder; holds <link>.stl of every link that is drawn, but for
  /// props (figure_files.h). "": primitives instead.
  std::string mesh_folder;
  std::bitset<2> tools;     // by Side: that hand's link shows <ToolFileName>.stl as well,
  std::string tool_folder;  // of this folder; otherwise as mesh_folder
  std::array<std::optional<HandSkeleton>, 2> gloves;  // by Side; where fingers are streamed
  std::bitset<kMostProps> props;                      // that are streamed
  /// Every link weighs something. Each of the two links inside a joint gets a hundredth of its
  /// segment's mass and inertia, which the segment's own link lacks: nothing changes in sum, and
  /// little in any pose. Fingers are paid for by their hand (44 % of it), a prop by the pelvis
  /// (1.5 % each): the mass of the whole stays the body's. For Gazebo.
  bool mass_inside_joints = false;
  std::array<double, 3> body_rgb = {0.78, 0.80, 0.84};  // sRGB, 0..1
};

/// `<model>_<link>`, such as "skeleton_right_forearm".
std::string LinkName(const std::string& model_name, int segment);
/// `<model>_<joint>_<axis>`, axis 0 1 2 = x y z, such as "skeleton_right_elbow_y".
std::string JointName(const std::string& model_name, int joint, int axis);

/// "left_second_mp": the name of its mesh file, without the ending.
std::string FingerFileName(Side side, int finger);

/// "right_tool", likewise. The mesh lies in the hand's link frame.
std::string ToolFileName(Side side);

/// "skeleton_left_second_mp"; its joints are `<that>_x`, `_y`, `_z`.
std::string FingerLinkName(const std::string& model_name, Side side, int finger);
std::string FingerJointName(const std::string& model_name, Side side, int finger, int axis);

/// "skeleton_prop1" for prop 0; its joints in the order of their chain: `_tx _ty _tz _y _x _z`.
std::string PropLinkName(const std::string& model_name, int prop);
std::array<std::string, 6> PropJointNames(const std::string& model_name, int prop);

/// The link without mass behind a joint that is not the last of its chain.
std::string LinkInside(const std::string& joint_name);

/// The whole document. Valid for urdfdom, robot_state_publisher and RViz.
std::string WriteUrdf(const HumanModel& human);

}  // namespace kinescope::urdf
