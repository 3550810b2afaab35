#include "urdf/robot/robot_model.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <mutex>
#include <set>
#include <string>

#include "urdf/robot/urdf_check.h"
#include "urdf/robot/urdfdom_lock.h"
#include "urdf/robot/xml_outline.h"

namespace kinescope::urdf {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

std::mutex*& ChosenMutex() {
  static std::mutex own;
  static std::mutex* chosen = &own;
  return chosen;
}

// urdfdom explains itself to console_bridge only. This collects it for the message of ours.
class Collector : public console_bridge::OutputHandler {
 public:
  Collector() : mutex_(UrdfdomMutex()) { console_bridge::useOutputHandler(this); }
  ~Collector() override { console_bridge::restorePreviousOutputHandler(); }

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level < console_bridge::CONSOLE_BRIDGE_LOG_ERROR) return;
    if (++count_ > 3) return;  // the first are the cause and its place, the rest follow from them
    if (!errors_.empty()) errors_ += ": ";
    errors_ += text;
  }

  bool is_empty() const { return errors_.empty(); }
  std::string reason() const { return is_empty() ? "urdfdom reports no reason" : errors_; }

 private:
  std::lock_guard<std::mutex> mutex_;
  std::string errors_;
  int count_ = 0;
};

// A link owns its children; left alone, a chain would be destroyed by as many nested calls as it
// has links.
class Dismantled {
 public:
  explicit Dismantled(::urdf::ModelInterfaceSharedPtr model) : model_(std::move(model)) {}
  ~Dismantled() {
    if (!model_) return;
    for (const auto& [name, link] : model_->links_) {
      link->child_links.clear();
      link->child_joints.clear();
    }
  }
  Dismantled(const Dismantled&) = delete;
  Dismantled& operator=(const Dismantled&) = delete;
  const ::urdf::ModelInterface* operator->() const { return model_.get(); }
  explicit operator bool() const { return model_ != nullptr && model_->getRoot() != nullptr; }

 private:
  ::urdf::ModelInterfaceSharedPtr model_;
};

Vector3d ToEigen(const ::urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Isometry3d ToEigen(const ::urdf::Pose& pose, const std::string& where) {
  Eigen::Quaterniond rotation;
  pose.rotation.getQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w());
  const Vector3d position = ToEigen(pose.position);
  if (!position.allFinite() || !rotation.coeffs().allFinite() ||
      std::abs(rotation.norm() - 1) > 1e-3) {
    throw UrdfError(where + ": <origin> contains a number that is not finite");
  }
  if (position.cwiseAbs().maxCoeff() > kMaxMeters) {
    throw UrdfError(where + ": <origin> is too far away");
  }
  Isometry3d transform = Isometry3d::Identity();
  transform.linear() = rotation.normalized().toRotationMatrix();
  transform.translation() = position;
  return transform;
}

void CheckSize(const Geometry& geometry, const std::string& where) {
  const bool is_mesh = geometry.kind == Geometry::Kind::kMesh;
  const double most = is_mesh ? kMaxScale : kMaxMeters;
  if (!geometry.size.allFinite()) {
    throw UrdfError(where + ": <geometry> has a size that is not finite");
  }
  if (!is_mesh && geometry.size.minCoeff() < 0) {
    throw UrdfError(where + ": <geometry> has a negative size");
  }
  if (geometry.size.cwiseAbs().maxCoeff() > most) {
    throw UrdfError(where + ": <geometry> is too large");
  }
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
  CheckSize(geometry, where);
  return geometry;
}

Visual ToVisual(const ::urdf::Visual& from, const std::string& where,
                std::vector<std::string>& notes) {
  Visual to;
  to.name = from.name;
  to.material = from.material_name;
  to.link_from_visual = ToEigen(from.origin, where);
  to.geometry = ToGeometry(*from.geometry, where);
  if (!from.material) return to;
  const auto& color = from.material->color;
  const Eigen::Vector4d rgba(color.r, color.g, color.b, color.a);
  const std::string& texture = from.material->texture_filename;
  // Without <color> urdfdom says black, which only makes sense under a texture.
  const bool is_default = rgba == Eigen::Vector4d(0, 0, 0, 1);
  if (!texture.empty()) notes.push_back(where + ": texture '" + texture + "' is not drawn");
  if (texture.empty() || !is_default) to.rgba = rgba;
  return to;
}

Inertial ToInertial(const ::urdf::Inertial& from, const std::string& where) {
  Inertial to;
  to.mass = from.mass;
  to.link_from_inertial = ToEigen(from.origin, where + ", <inertial>");
  to.inertia << from.ixx, from.ixy, from.ixz,  //
      from.ixy, from.iyy, from.iyz,            //
      from.ixz, from.iyz, from.izz;
  if (!std::isfinite(to.mass) || !to.inertia.allFinite()) {
    throw UrdfError(where + ": <inertial> contains a number that is not finite");
  }
  return to;
}

Link ToLink(const ::urdf::Link& from, std::vector<std::string>& notes) {
  Link link;
  link.name = from.name;
  const std::string where = "link '" + from.name + "'";
  if (from.inertial) {
    link.inertial = ToInertial(*from.inertial, where);
    link.mass = link.inertial->mass;
  }
  for (const auto& visual : from.visual_array) {
    if (!visual || !visual->geometry) continue;
    Visual made = ToVisual(*visual, where, notes);
    if (!visual->material && !link.visuals.empty()) made.rgba = link.visuals.back().rgba;
    link.visuals.push_back(std::move(made));
  }
  for (const auto& collision : from.collision_array) {
    if (!collision || !collision->geometry) continue;
    link.collisions.push_back({ToEigen(collision->origin, where),
                               ToGeometry(*collision->geometry, where), collision->name});
  }
  return link;
}

RobotJoint::Type ToType(const ::urdf::Joint& from, const std::string& where,
                        std::vector<std::string>& notes) {
  using Type = RobotJoint::Type;
  switch (from.type) {
    case ::urdf::Joint::FIXED: return Type::kFixed;
    case ::urdf::Joint::REVOLUTE: return Type::kRevolute;
    case ::urdf::Joint::CONTINUOUS: return Type::kContinuous;
    case ::urdf::Joint::PRISMATIC: return Type::kPrismatic;
    case ::urdf::Joint::FLOATING:
      notes.push_back(where + ": is floating; drawn at its origin");
      return Type::kFloating;
    case ::urdf::Joint::PLANAR:
      notes.push_back(where + ": is planar; drawn at its origin");
      return Type::kPlanar;
    default: break;
  }
  throw UrdfError(where + ": has an unknown type");
}

RobotJoint ToJoint(const ::urdf::Joint& from, std::vector<std::string>& notes) {
  RobotJoint joint;
  const std::string where = "joint '" + from.name + "'";
  joint.name = from.name;
  joint.parent_link = from.parent_link_name;
  joint.child_link = from.child_link_name;
  joint.parent_from_joint = ToEigen(from.parent_to_joint_origin_transform, where);
  joint.axis = ToEigen(from.axis);
  joint.type = ToType(from, where, notes);
  if (joint.HasPosition() && !(joint.axis.allFinite() && joint.axis.norm() > 1e-6)) {
    throw UrdfError(where + ": <axis> gives no direction");
  }
  if (from.limits) {
    joint.limits = {from.limits->lower, from.limits->upper, from.limits->effort,
                    from.limits->velocity};
  }
  if (from.mimic)
    joint.mimic = {from.mimic->joint_name, from.mimic->multiplier, from.mimic->offset};
  if (from.dynamics) {
    joint.damping = from.dynamics->damping;
    joint.friction = from.dynamics->friction;
  }
  return joint;
}

}  // namespace

std::mutex& UrdfdomMutex() { return *ChosenMutex(); }

void UseUrdfdomMutexOf(std::mutex& program) { ChosenMutex() = &program; }

RobotModel Translucent(RobotModel model, double opacity) {
  for (Link& link : model.links) {
    for (Visual& visual : link.visuals) visual.opacity *= opacity;
  }
  return model;
}

RobotModel ParseUrdf(const std::string& xml) {
  RefuseUnreadable(ReadOutline(xml));
  const Collector collector;
  const Dismantled parsed(::urdf::parseURDF(xml));
  // urdfdom leaves out what it cannot read and goes on.
  if (!parsed || !collector.is_empty()) {
    throw UrdfError("not a usable URDF: " + collector.reason());
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
    model.links.push_back(ToLink(*link, model.notes));
    for (const auto& joint : link->child_joints)
      model.joints.push_back(ToJoint(*joint, model.notes));
    for (const auto& child : link->child_links) open.push_back(child);
  }
  return model;
}

}  // namespace kinescope::urdf
