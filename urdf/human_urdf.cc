#include "urdf/human_urdf.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "urdf/hand_surface.h"
#include "urdf/joint_limits.h"
#include "urdf/primitive_body.h"

namespace kinescope::urdf {
namespace {

using Eigen::Vector3d;

constexpr std::array<const char*, 3> kAxisName = {"x", "y", "z"};
constexpr std::array<int, 3> kChainOrder = {1, 0, 2};  // y, then x, then z
constexpr std::array<const char*, 2> kSidePrefix = {"right_", "left_"};

std::string Origin(const Vector3d& xyz, const Vector3d& rpy = Vector3d::Zero()) {
  return fmt::format("<origin xyz=\"{} {} {}\" rpy=\"{} {} {}\"/>", xyz.x(), xyz.y(), xyz.z(),
                     rpy.x(), rpy.y(), rpy.z());
}

std::string InertialXml(const SegmentInertia& segment, double share) {
  const Eigen::Matrix3d i = share * segment.inertia_about_com;
  return fmt::format(
      "    <inertial>\n      {}\n      <mass value=\"{}\"/>\n"
      "      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" izz=\"{}\"/>\n"
      "    </inertial>\n",
      Origin(segment.com_in_link), share * segment.mass, i(0, 0), i(0, 1), i(0, 2), i(1, 1),
      i(1, 2), i(2, 2));
}

std::string ShapeXml(const Primitive& part) {
  switch (part.kind) {
    case Primitive::Kind::kBox:
      return fmt::format("<box size=\"{} {} {}\"/>", part.size.x(), part.size.y(), part.size.z());
    case Primitive::Kind::kCylinder:
      return fmt::format("<cylinder radius=\"{}\" length=\"{}\"/>", part.size.x(), part.size.y());
    case Primitive::Kind::kSphere: break;
  }
  return fmt::format("<sphere radius=\"{}\"/>", part.size.x());
}

std::string Shapes(const char* kind, const std::vector<Primitive>& parts,
                   const std::string& material = "") {
  std::string text;
  for (const Primitive& part : parts) {
    text += fmt::format("    <{}>\n      {}\n      <geometry>{}</geometry>\n{}    </{}>\n", kind,
                        Origin(part.center, part.rpy), ShapeXml(part), material, kind);
  }
  return text;
}

std::string Material(const char* name) {
  return fmt::format("      <material name=\"{}\"/>\n", name);
}

std::string Collisions(const std::vector<Primitive>& parts) { return Shapes("collision", parts); }

// Null where the segment is no gloved hand.
const HandSkeleton* GloveOn(const HumanModel& human, int segment) {
  for (const Side side : {kRight, kLeft}) {
    if (segment == HandSegmentOf(side) && human.gloves[side]) return &*human.gloves[side];
  }
  return nullptr;
}

// As URIs want it, which is safe in XML too: a folder's name is the user's.
std::string UriOf(const std::string& folder) {
  if (folder.rfind("package://", 0) == 0 || folder.rfind("http://", 0) == 0) return folder;
  std::string uri = "file://";
  for (const char c : folder) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') ||
                          std::string_view("/-._~+").find(c) != std::string_view::npos;
    uri += is_plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return uri;
}

std::string MeshVisual(const std::string& folder, const std::string& name, const char* material) {
  return fmt::format(
      "    <visual>\n      {}\n      <geometry><mesh filename=\"{}/{}.stl\"/></geometry>\n"
      "{}    </visual>\n",
      Origin(Vector3d::Zero()), UriOf(folder), name, Material(material));
}

// `name`: the link's without its prefix, which is its mesh's too.
std::string Visuals(const HumanModel& human, const std::string& name,
                    const std::vector<Primitive>& parts, const char* material) {
  if (human.mesh_folder.empty()) return Shapes("visual", parts, Material(material));
  return MeshVisual(human.mesh_folder, name, material);
}

// "" where `segment` is no hand that holds a tool.
std::string ToolVisual(const HumanModel& human, int segment) {
  for (const Side side : {kRight, kLeft}) {
    if (segment != HandSegmentOf(side) || !human.tools.test(side)) continue;
    return MeshVisual(human.tool_folder, ToolFileName(side), kToolMaterial);
  }
  return "";
}

// Of a gloved hand the segments are drawn; the hand's own link has its mass, and what surrounds it.
std::string SegmentShapes(const HumanModel& human, int segment) {
  const std::string tool = ToolVisual(human, segment);
  if (const HandSkeleton* glove = GloveOn(human, segment)) {
    return tool + Collisions({PalmBoxInHand(*glove)});
  }
  const std::vector<Primitive> parts = PrimitiveBody(human.skeleton, segment);
  return Visuals(human, std::string(kSegments[At(segment)].link_name), parts, "body") + tool +
         Collisions(parts);
}

std::string LinkElement(const std::string& name, const std::string& content) {
  if (content.empty()) return "  <link name=\"" + name + "\"/>\n";
  return "  <link name=\"" + name + "\">\n" + content + "  </link>\n";
}

std::string JointElement(const std::string& name, const char* type, const std::string& parent,
                         const std::string& child, const Vector3d& offset, int axis,
                         const AxisLimit& limit) {
  return fmt::format(
      "  <joint name=\"{}\" type=\"{}\">\n    <parent link=\"{}\"/>\n"
      "    <child link=\"{}\"/>\n    {}\n    <axis xyz=\"{} {} {}\"/>\n"
      "    <limit lower=\"{}\" upper=\"{}\" effort=\"{}\" velocity=\"{}\"/>\n  </joint>\n",
      name, type, parent, child, Origin(offset), axis == 0 ? 1 : 0, axis == 1 ? 1 : 0,
      axis == 2 ? 1 : 0, limit.lower, limit.upper, limit.effort, limit.velocity);
}

// The revolute joints `<name>_y`, `_x`, `_z` from one link to another and the two links between.
struct JointBall {
  std::string name, parent, child;
  Vector3d offset;                          // of the child, in the parent
  std::function<AxisLimit(int)> limit;      // by axis
  std::string content_of_the_links_inside;  // "": they are empty
};

std::string BallChain(const JointBall& ball) {
  std::string text;
  std::string parent = ball.parent;
  for (std::size_t i = 0; i < kChainOrder.size(); ++i) {
    const int axis = kChainOrder[i];
    const bool is_last = i + 1 == kChainOrder.size();
    const std::string joint = ball.name + "_" + kAxisName[At(axis)];
    const std::string child = is_last ? ball.child : LinkInside(joint);
    if (!is_last) text += LinkElement(child, ball.content_of_the_links_inside);
    text += JointElement(joint, "revolute", parent, child, i == 0 ? ball.offset : Vector3d::Zero(),
                         axis, ball.limit(axis));
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

std::string BodyJointName(const std::string& model_name, int joint) {
  return Cleaned(model_name) + "_" + std::string(kJoints[At(joint)].ros_name);
}

// HumanModel::mass_inside_joints: what a link gets of the segment that lacks it.
constexpr double kShareInside = 0.01;         // of the joint's own segment
constexpr double kShareOfFinger = 0.02;       // of its hand
constexpr double kShareInsideFinger = 0.001;  // of its hand
constexpr double kShareOfProp = 0.01;         // of the pelvis
constexpr double kShareInsideProp = 0.001;    // of the pelvis

double OwnShare(const HumanModel& human, int segment) {
  if (!human.mass_inside_joints) return 1;
  double share = 1;
  if (segment != kPelvis) share -= 2 * kShareInside;
  if (GloveOn(human, segment) != nullptr) {
    share -= kFingersPerHand * (kShareOfFinger + 2 * kShareInsideFinger);
  }
  if (segment == kPelvis) {
    share -= static_cast<double>(human.props.count()) * (kShareOfProp + 5 * kShareInsideProp);
  }
  return share;
}

// "" where such links weigh nothing. The tensor is the segment's own, which is larger than it need
// be and so can only calm a simulator.
std::string SmallInertial(const HumanModel& human, int segment, double share,
                          const Vector3d& com = Vector3d::Zero()) {
  if (!human.mass_inside_joints) return "";
  SegmentInertia part = human.body[At(segment)];
  part.com_in_link = com;
  return InertialXml(part, share);
}

std::string Body(const HumanModel& human) {
  std::string text;
  for (int segment = 0; segment < kSegmentCount; ++segment) {
    text += LinkElement(LinkName(human.model_name, segment),
                        InertialXml(human.body[At(segment)], OwnShare(human, segment)) +
                            SegmentShapes(human, segment));
  }
  for (int joint = 0; joint < kJointCount; ++joint) {
    const int child = ChildOf(joint);
    text += BallChain(
        {BodyJointName(human.model_name, joint), LinkName(human.model_name, ParentOf(joint)),
         LinkName(human.model_name, child), human.skeleton.origin_in_parent[At(child)],
         [joint](int axis) { return LimitOf(joint, axis); },
         SmallInertial(human, child, kShareInside, human.body[At(child)].com_in_link)});
  }
  return text;
}

std::string Glove(const HumanModel& human, Side side) {
  const HandSkeleton& glove = *human.gloves[side];
  const int hand = HandSegmentOf(side);
  std::string text;
  for (int finger = 0; finger < kFingersPerHand; ++finger) {
    const std::string name = FingerLinkName(human.model_name, side, finger);
    const int parent = kFingerParents[At(finger)];
    const std::vector<Primitive> parts = FingerPrimitives(glove, finger);
    // The carpus: its hand's link collides in its place.
    const std::string collisions = finger == 0 ? "" : Collisions(parts);
    text += LinkElement(
        name, SmallInertial(human, hand, kShareOfFinger, 0.5 * EndOf(glove, finger)) +
                  Visuals(human, FingerFileName(side, finger), parts, "glove") + collisions);
    text += BallChain({name,
                       parent < 0 ? LinkName(human.model_name, hand)
                                  : FingerLinkName(human.model_name, side, parent),
                       name, glove.origin_in_parent[At(finger)],
                       [&](int axis) { return LimitOf(KindOf(finger), side == kLeft, axis); },
                       SmallInertial(human, hand, kShareInsideFinger)});
  }
  return text;
}

std::string Prop(const HumanModel& human, int prop) {
  // Wherever it is: nothing holds it. Farther than a suit's radio reaches.
  constexpr double kFarAway = 100;  // m
  const AxisLimit anywhere{-kFarAway, kFarAway, 1000, 100};
  const AxisLimit any_turn{-2 * M_PI, 2 * M_PI, 100, 100};
  Primitive mark;  // what it looks like is not streamed
  mark.size = Vector3d::Constant(0.06);
  const std::string name = PropLinkName(human.model_name, prop);
  std::string text =
      LinkElement(name, SmallInertial(human, kPelvis, kShareOfProp) +
                            Shapes("visual", {mark}, Material("prop")) + Collisions({mark}));
  const auto joints = PropJointNames(human.model_name, prop);
  std::string parent = LinkName(human.model_name, kPelvis);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const bool slides = i < 3;
    const bool is_last = i + 1 == joints.size();
    const std::string child = is_last ? name : LinkInside(joints[i]);
    if (!is_last) {
      text += LinkElement(child, SmallInertial(human, kPelvis, kShareInsideProp));
    }
    text += JointElement(joints[i], slides ? "prismatic" : "revolute", parent, child,
                         Vector3d::Zero(), slides ? static_cast<int>(i) : kChainOrder[i - 3],
                         slides ? anywhere : any_turn);
    parent = child;
  }
  return text;
}

}  // namespace

std::string LinkName(const std::string& model_name, int segment) {
  return Cleaned(model_name) + "_" + std::string(kSegments[At(segment)].link_name);
}

std::string JointName(const std::string& model_name, int joint, int axis) {
  return BodyJointName(model_name, joint) + "_" + kAxisName[At(axis)];
}

std::string FingerFileName(Side side, int finger) {
  std::string name = kSidePrefix[side];
  const std::string_view words = kFingers[At(finger)];  // "SecondMP" -> "second_mp"
  for (std::size_t i = 0; i < words.size(); ++i) {
    const bool is_upper = words[i] >= 'A' && words[i] <= 'Z';
    const bool begins_word = is_upper && i > 0 && words[i - 1] >= 'a';
    if (begins_word) name += '_';
    name += is_upper ? static_cast<char>(words[i] - 'A' + 'a') : words[i];
  }
  return name;
}

std::string ToolFileName(Side side) { return std::string(kSidePrefix[side]) + "tool"; }

std::string FingerLinkName(const std::string& model_name, Side side, int finger) {
  return Cleaned(model_name) + "_" + FingerFileName(side, finger);
}

std::string FingerJointName(const std::string& model_name, Side side, int finger, int axis) {
  return FingerLinkName(model_name, side, finger) + "_" + kAxisName[At(axis)];
}

std::string PropLinkName(const std::string& model_name, int prop) {
  return fmt::format("{}_prop{}", Cleaned(model_name), prop + 1);
}

std::array<std::string, 6> PropJointNames(const std::string& model_name, int prop) {
  const std::string name = PropLinkName(model_name, prop);
  return {name + "_tx", name + "_ty", name + "_tz", name + "_y", name + "_x", name + "_z"};
}

std::string LinkInside(const std::string& joint_name) { return joint_name + "_link"; }

bool IsWrittenByKinescope(std::string_view urdf) {
  constexpr std::size_t kBeginning = 400;  // bytes
  return urdf.substr(0, kBeginning).find(kWrittenByKinescope) != std::string_view::npos;
}

std::string WriteUrdf(const HumanModel& human) {
  const bool has_gloves = human.gloves[kRight] || human.gloves[kLeft];
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n"
      "<!-- A person of {:.3f} m and {:.1f} kg, {}. Each joint turns about y, "
      "then\n"
      "     x, then z. Link frames: x forward, y left, z up in the N-pose. -->\n"
      "<robot name=\"{}\">\n"
      "  <material name=\"body\"><color rgba=\"{:.6g} {:.6g} {:.6g} 1\"/></material>\n",
      human.skeleton.height, TotalMass(human.body), kWrittenByKinescope, Cleaned(human.model_name),
      human.body_rgb[0], human.body_rgb[1], human.body_rgb[2]);
  if (has_gloves) {
    text += "  <material name=\"glove\"><color rgba=\"0.55 0.60 0.68 1\"/></material>\n";
  }
  if (human.tools.any()) {
    text += "  <material name=\"" + std::string(kToolMaterial) +
            "\"><color rgba=\"0.23 0.26 0.31 1\"/></material>\n";
  }
  if (human.props.any()) {
    text += "  <material name=\"prop\"><color rgba=\"0.42 0.46 0.54 1\"/></material>\n";
  }
  text += Body(human);
  for (const Side side : {kLeft, kRight}) {
    if (human.gloves[side]) text += Glove(human, side);
  }
  for (int prop = 0; prop < kMaxProps; ++prop) {
    if (human.props.test(At(prop))) text += Prop(human, prop);
  }
  return text + "</robot>\n";
}

}  // namespace kinescope::urdf
