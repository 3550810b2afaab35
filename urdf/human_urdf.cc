#include "urdf/human_urdf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "urdf/primitive_figure.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 3> kAxisName = {"x", "y", "z"};
constexpr std::array<int, 3> kChainOrder = {1, 0, 2};  // y, then x, then z

struct Range {
  double low, high;  // degrees
};
using Ranges = std::array<Range, 3>;  // x, y, z

// Active range of motion, rounded outwards by some 10 degrees, in the axes of the right side's
// links (forward flexion of arm and hip and bending of the elbow are negative about y). Where the
// Cardan angles of a wide ranging joint can pass through their singularity, the whole turn is
// allowed.
Ranges RangesOf(int joint) {
  switch (joint) {
    case jL5S1:
    case jL4L3:
    case jL1T12:
    case jT9T8: return {{{-25, 25}, {-25, 45}, {-25, 25}}};
    case jT1C7:
    case jC1Head: return {{{-50, 50}, {-60, 60}, {-80, 80}}};
    case jRightC7Shoulder:
    case jLeftC7Shoulder: return {{{-50, 30}, {-35, 35}, {-40, 40}}};
    case jRightShoulder:
    case jLeftShoulder: return {{{-200, 200}, {-200, 200}, {-200, 200}}};
    case jRightElbow:
    case jLeftElbow: return {{{-30, 30}, {-170, 20}, {-130, 130}}};
    case jRightWrist:
    case jLeftWrist: return {{{-100, 100}, {-55, 55}, {-45, 45}}};
    case jRightHip:
    case jLeftHip: return {{{-90, 60}, {-150, 50}, {-80, 80}}};
    case jRightKnee:
    case jLeftKnee: return {{{-25, 25}, {-20, 170}, {-50, 50}}};
    case jRightAnkle:
    case jLeftAnkle: return {{{-50, 50}, {-50, 75}, {-50, 50}}};
    default: return {{{-25, 25}, {-90, 55}, {-25, 25}}};
  }
}

bool IsLeft(int joint) { return kJoints[At(joint)].ros_name.substr(0, 5) == "left_"; }

Range RangeOf(int joint, int axis) {
  Range range = RangesOf(joint)[At(axis)];
  if (IsLeft(joint) && axis != 1)
    range = {-range.high, -range.low};  // mirrored in the sagittal plane
  return range;
}

std::string Origin(const Vector3d& xyz, const Vector3d& rpy = Vector3d::Zero()) {
  return fmt::format("<origin xyz=\"{:.9g} {:.9g} {:.9g}\" rpy=\"{:.9g} {:.9g} {:.9g}\"/>", xyz.x(),
                     xyz.y(), xyz.z(), rpy.x(), rpy.y(), rpy.z());
}

std::string Inertial(const SegmentInertia& segment) {
  const Vector3d& i = segment.inertia_about_com;
  return fmt::format(
      "    <inertial>\n      {}\n      <mass value=\"{:.9g}\"/>\n"
      "      <inertia ixx=\"{:.9g}\" ixy=\"0\" ixz=\"0\" iyy=\"{:.9g}\" iyz=\"0\" "
      "izz=\"{:.9g}\"/>\n"
      "    </inertial>\n",
      Origin(segment.com_in_link), segment.mass, i.x(), i.y(), i.z());
}

std::string Shape(const Primitive& part) {
  switch (part.kind) {
    case Primitive::Kind::kBox:
      return fmt::format("<box size=\"{:.6g} {:.6g} {:.6g}\"/>", part.size.x(), part.size.y(),
                         part.size.z());
    case Primitive::Kind::kCylinder:
      return fmt::format("<cylinder radius=\"{:.6g}\" length=\"{:.6g}\"/>", part.size.x(),
                         part.size.y());
    case Primitive::Kind::kSphere: break;
  }
  return fmt::format("<sphere radius=\"{:.6g}\"/>", part.size.x());
}

std::string Shapes(const HumanModel& human, int segment) {
  std::string text;
  const std::string& folder = human.mesh_folder;
  if (!folder.empty()) {
    text += fmt::format(
        "    <visual>\n      {}\n      <geometry><mesh filename=\"file://{}/{}.stl\"/></geometry>\n"
        "      <material name=\"body\"/>\n    </visual>\n",
        Origin(Vector3d::Zero()), folder, kSegments[At(segment)].link_name);
  }
  for (const Primitive& part : PrimitiveFigure(human.skeleton, segment)) {
    const std::string body = fmt::format("      {}\n      <geometry>{}</geometry>\n",
                                         Origin(part.center, part.rpy), Shape(part));
    if (folder.empty()) {
      text += "    <visual>\n" + body + "      <material name=\"body\"/>\n    </visual>\n";
    }
    text += "    <collision>\n" + body + "    </collision>\n";
  }
  return text;
}

std::string JointElement(const HumanModel& human, int joint, int axis, const std::string& parent,
                         const std::string& child, const Vector3d& offset) {
  const Range range = RangeOf(joint, axis);
  const double to_rad = M_PI / 180;
  // Effort and velocity only have to be there and to be larger than any person's.
  return fmt::format(
      "  <joint name=\"{}\" type=\"revolute\">\n    <parent link=\"{}\"/>\n"
      "    <child link=\"{}\"/>\n    {}\n    <axis xyz=\"{} {} {}\"/>\n"
      "    <limit lower=\"{:.6f}\" upper=\"{:.6f}\" effort=\"500\" velocity=\"50\"/>\n  </joint>\n",
      JointName(human.model_name, joint, axis), parent, child, Origin(offset), axis == 0 ? 1 : 0,
      axis == 1 ? 1 : 0, axis == 2 ? 1 : 0, range.low * to_rad, range.high * to_rad);
}

// The three revolute joints of one human joint and the two links between them. Those have no mass:
// KDL, robot_state_publisher and RViz take them so, and a mass of our invention would falsify sums.
std::string JointChain(const HumanModel& human, int joint) {
  std::string text;
  std::string parent = LinkName(human.model_name, ParentOf(joint));
  for (std::size_t i = 0; i < kChainOrder.size(); ++i) {
    const int axis = kChainOrder[i];
    const bool is_last = i + 1 == kChainOrder.size();
    const std::string child = is_last ? LinkName(human.model_name, ChildOf(joint))
                                      : JointName(human.model_name, joint, axis) + "_link";
    if (!is_last) text += "  <link name=\"" + child + "\"/>\n";
    const Vector3d offset =
        i == 0 ? human.skeleton.origin_in_parent[At(ChildOf(joint))] : Vector3d::Zero();
    text += JointElement(human, joint, axis, parent, child, offset);
    parent = child;
  }
  return text;
}

// A name is the user's or the stream's: only what is safe in XML and as a ROS name stays.
std::string Cleaned(std::string name) {
  for (char& c : name) {
    const bool is_good =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    if (!is_good) c = '_';
  }
  return name.empty() ? "skeleton" : name;
}

}  // namespace

std::string LinkName(const std::string& model_name, int segment) {
  return Cleaned(model_name) + "_" + std::string(kSegments[At(segment)].link_name);
}

std::string JointName(const std::string& model_name, int joint, int axis) {
  return Cleaned(model_name) + "_" + std::string(kJoints[At(joint)].ros_name) + "_" +
         kAxisName[At(axis)];
}

std::string WriteUrdf(const HumanModel& human) {
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<!-- A person of {:.3f} m and {:.1f} kg, written by Kinescope. Each joint turns about y, "
      "then\n"
      "     x, then z. Link frames: x forward, y left, z up in the N-pose. -->\n"
      "<robot name=\"{}\">\n"
      "  <material name=\"body\"><color rgba=\"0.78 0.80 0.84 1\"/></material>\n",
      human.skeleton.height, TotalMass(human.body), Cleaned(human.model_name));
  for (int segment = 0; segment < kSegmentCount; ++segment) {
    text += "  <link name=\"" + LinkName(human.model_name, segment) + "\">\n" +
            Inertial(human.body[At(segment)]) + Shapes(human, segment) + "  </link>\n";
  }
  for (int joint = 0; joint < kJointCount; ++joint) text += JointChain(human, joint);
  return text + "</robot>\n";
}

}  // namespace kinescope::urdf
