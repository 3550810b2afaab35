#include "urdf/robot_model.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <mutex>
#include <set>
#include <string>

namespace kinescope::urdf {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

// Far above any robot; keeps a hostile document from being expanded into gigabytes.
constexpr std::size_t kMaxDocumentBytes = 32u << 20;
constexpr std::size_t kMaxElements = 10000;

// urdfdom explains itself to console_bridge only. This collects it for the message of ours.
class Collector : public console_bridge::OutputHandler {
 public:
  Collector() : mutex_(GlobalMutex()) { console_bridge::useOutputHandler(this); }
  ~Collector() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (++count_ > 3) return;  // the first are the cause and its place, the rest follow from them
    if (!errors_.empty()) errors_ += ": ";
    errors_ += text;
  }

  bool is_empty() const { return errors_.empty(); }
  std::string reason() const { return is_empty() ? "urdfdom gives no reason" : errors_; }

 private:
  static std::mutex& GlobalMutex() {  // the handler is global to the process
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> mutex_;
  std::string errors_;
  int count_ = 0;
};

Vector3d ToEigen(const ::urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Isometry3d ToEigen(const ::urdf::Pose& pose, const std::string& where) {
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  if (!ToEigen(pose.position).allFinite() || !rotation.coeffs().allFinite() ||
      std::abs(rotation.norm() - 1) > 1e-3) {
    throw UrdfError(where + ": <origin> holds a number that is not finite");
  }
  Isometry3d transform = Isometry3d::Identity();
  transform.linear() = rotation.normalized().toRotationMatrix();
  transform.translation() = ToEigen(pose.position);
  return transform;
}

Geometry ToGeometry(const ::urdf::Geometry& from, const std::string& where) {
  Geometry geometry;
  switch (from.type) {
    case ::urdf::Geometry::BOX:
      geometry.kind = Geometry::Kind::kBox;
      geometry.size = ToEigen(static_cast<const ::urdf::Box&>(from).dim);
      break;
    case ::urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const ::urdf::Cylinder&>(from);
      geometry.kind = Geometry::Kind::kCylinder;
      geometry.size = {cylinder.radius, cylinder.length, 0};
      break;
    }
    case ::urdf::Geometry::SPHERE:
      geometry.kind = Geometry::Kind::kSphere;
      geometry.size = {static_cast<const ::urdf::Sphere&>(from).radius, 0, 0};
      break;
    case ::urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const ::urdf::Mesh&>(from);
      geometry.kind = Geometry::Kind::kMesh;
      geometry.size = ToEigen(mesh.scale);
      geometry.mesh_uri = mesh.filename;
      break;
    }
  }
  if (!geometry.size.allFinite())
    throw UrdfError(where + ": <geometry> has a size that is not finite");
  const bool is_mesh = geometry.kind == Geometry::Kind::kMesh;
  if (!is_mesh && geometry.size.minCoeff() < 0) {
    throw UrdfError(where + ": <geometry> has a negative size");
  }
  return geometry;
}

Link ToLink(const ::urdf::Link& from) {
  Link link;
  link.name = from.name;
  if (from.inertial) link.mass = from.inertial->mass;
  const std::string where = "link '" + from.name + "'";
  for (const auto& visual : from.visual_array) {
    if (!visual || !visual->geometry) continue;
    Visual& to = link.visuals.emplace_back();
    to.link_from_visual = ToEigen(visual->origin, where);
    to.geometry = ToGeometry(*visual->geometry, where);
    if (visual->material) {
      const auto& color = visual->material->color;
      to.rgba = Eigen::Vector4d(color.r, color.g, color.b, color.a);
    }
  }
  return link;
}

RobotJoint ToJoint(const ::urdf::Joint& from) {
  RobotJoint joint;
  joint.name = from.name;
  joint.parent_link = from.parent_link_name;
  joint.child_link = from.child_link_name;
  joint.parent_from_joint =
      ToEigen(from.parent_to_joint_origin_transform, "joint '" + from.name + "'");
  joint.axis = ToEigen(from.axis);
  switch (from.type) {
    case ::urdf::Joint::FIXED: joint.type = RobotJoint::Type::kFixed; break;
    case ::urdf::Joint::REVOLUTE: joint.type = RobotJoint::Type::kRevolute; break;
    case ::urdf::Joint::CONTINUOUS: joint.type = RobotJoint::Type::kContinuous; break;
    case ::urdf::Joint::PRISMATIC: joint.type = RobotJoint::Type::kPrismatic; break;
    default: joint.type = RobotJoint::Type::kOther; break;
  }
  const bool moves = joint.type != RobotJoint::Type::kFixed;
  if (moves && !(joint.axis.allFinite() && joint.axis.norm() > 1e-6)) {
    throw UrdfError("joint '" + from.name + "': <axis> is not a direction");
  }
  return joint;
}

}  // namespace

RobotModel ParseUrdf(const std::string& xml) {
  if (xml.size() > kMaxDocumentBytes) {
    throw UrdfError("the URDF has " + std::to_string(xml.size()) + " bytes; the most we read is " +
                    std::to_string(kMaxDocumentBytes));
  }
  const Collector collector;
  const ::urdf::ModelInterfaceSharedPtr parsed = ::urdf::parseURDF(xml);
  // urdfdom leaves out what it cannot read and goes on; a robot without its arm is worse than none.
  if (!parsed || !parsed->getRoot() || !collector.is_empty()) {
    throw UrdfError("not a usable URDF: " + collector.reason());
  }
  if (parsed->links_.size() > kMaxElements) {
    throw UrdfError("the URDF has " + std::to_string(parsed->links_.size()) +
                    " links; the most we draw is " + std::to_string(kMaxElements));
  }

  RobotModel model;
  model.name = parsed->getName();
  model.root_link = parsed->getRoot()->name;
  // Breadth first, so that parents come before children; a list, because chains can be deep.
  std::vector<::urdf::LinkConstSharedPtr> open = {parsed->getRoot()};
  std::set<std::string> seen;
  for (std::size_t next = 0; next < open.size(); ++next) {
    const ::urdf::LinkConstSharedPtr link = open[next];
    // urdfdom lets a link hang on two joints, and then a loop be reached from the root.
    if (!seen.insert(link->name).second) {
      throw UrdfError("link '" + link->name + "' is the child of two joints");
    }
    model.links.push_back(ToLink(*link));
    for (const auto& joint : link->child_joints) model.joints.push_back(ToJoint(*joint));
    for (const auto& child : link->child_links) open.push_back(child);
  }
  return model;
}

}  // namespace kinescope::urdf
