#include "server/ros/transforms.h"

#include "server/ros/convert.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::Pose;

Pose Relative(const Pose& from, const Pose& to) {
  const Quaterniond back = from.orientation.conjugate();
  return {back * (to.position - from.position), back * to.orientation};
}

// Writes transforms one after another into a message that keeps its memory.
class Writer {
 public:
  Writer(tf2_msgs::TFMessage& message, const std::string& reference_frame, const ros::Time& stamp)
      : message_(message), reference_frame_(reference_frame), stamp_(stamp) {}

  void Add(const std::string& parent, const std::string& child, const Pose& parent_from_child) {
    geometry_msgs::TransformStamped& out = message_.transforms[next_++];
    out.header.stamp = stamp_;
    out.header.frame_id = parent;
    out.child_frame_id = child;
    Set(out.transform.translation, parent_from_child.position);
    Set(out.transform.rotation, parent_from_child.orientation);
  }

  void AddToReference(const std::string& child, const Pose& world_from_child) {
    Add(reference_frame_, child, world_from_child);
  }

 private:
  tf2_msgs::TFMessage& message_;
  const std::string& reference_frame_;
  const ros::Time stamp_;
  std::size_t next_ = 0;
};

// Poses after a joint's turn about y, and after its turn about x. Both sit where the child really
// is: measured segments are not rigid, and the URDF puts the joint at the child's origin.
std::array<Pose, 2> Between(const PersonState& person, int joint) {
  const Pose& parent = person.links[At(urdf::ParentOf(joint))];
  const Vector3d& origin = person.links[At(urdf::ChildOf(joint))].position;
  const Vector3d& angles = person.angles[At(joint)];
  const Quaterniond after_y = parent.orientation * AngleAxisd(angles.y(), Vector3d::UnitY());
  return {Pose{origin, after_y}, Pose{origin, after_y * AngleAxisd(angles.x(), Vector3d::UnitX())}};
}

void WriteFlat(const PersonState& person, const PersonNames& names, Writer& out) {
  for (const int segment : SegmentsByName()) {
    out.AddToReference(names.links[At(segment)], person.links[At(segment)]);
  }
  for (const int joint : JointsByName()) {
    const auto poses = Between(person, joint);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out.AddToReference(names.between[At(joint)][i], poses[i]);
    }
  }
}

void WriteTree(const PersonState& person, const PersonNames& names, Writer& out) {
  for (const int segment : SegmentsByName()) {
    const Pose& link = person.links[At(segment)];
    if (segment == urdf::kPelvis) {
      out.AddToReference(names.links[At(segment)], link);
      continue;
    }
    const int joint = segment - 1;
    out.Add(names.between[At(joint)][1], names.links[At(segment)],
            Relative(Between(person, joint)[1], link));
  }
  for (const int joint : JointsByName()) {
    const auto poses = Between(person, joint);
    const int parent = urdf::ParentOf(joint);
    out.Add(names.links[At(parent)], names.between[At(joint)][0],
            Relative(person.links[At(parent)], poses[0]));
    out.Add(names.between[At(joint)][0], names.between[At(joint)][1], Relative(poses[0], poses[1]));
  }
}

urdf::Side SideOf(int extra) {
  return extra < FingerIndex(urdf::kRight, 0) ? urdf::kLeft : urdf::kRight;
}

int HandOf(int extra) { return SideOf(extra) == urdf::kLeft ? urdf::kLeftHand : urdf::kRightHand; }

Pose LinkPoseOf(const PersonState& person, int extra) {
  Pose pose = person.sample.extra.poses[At(extra)];
  if (extra >= kMostProps)
    pose.orientation = pose.orientation * urdf::SegmentFromLink(HandOf(extra));
  return pose;
}

void WriteExtra(const PersonState& person, const PersonNames& names, TfShape shape, Writer& out) {
  for (int extra = 0; extra < kExtraCount; ++extra) {
    if (!person.sample.extra.present.test(At(extra))) continue;
    const Pose pose = LinkPoseOf(person, extra);
    if (shape == TfShape::kFlat || extra < kMostProps) {
      out.AddToReference(names.extra[At(extra)], pose);
      continue;
    }
    const int first = FingerIndex(SideOf(extra), 0);
    const int parent = kFingerParents[At(extra - first)];
    const bool hangs_on_finger =
        parent >= 0 && person.sample.extra.present.test(At(first + parent));
    if (hangs_on_finger) {
      out.Add(names.extra[At(first + parent)], names.extra[At(extra)],
              Relative(LinkPoseOf(person, first + parent), pose));
    } else {
      out.Add(names.links[At(HandOf(extra))], names.extra[At(extra)],
              Relative(person.links[At(HandOf(extra))], pose));
    }
  }
}

}  // namespace

void AddObjects(const SceneState& scene, const PersonNames& names,
                const std::string& reference_frame, tf2_msgs::TFMessage& message) {
  for (const TrackedObject& object : scene.objects) {
    geometry_msgs::TransformStamped out;
    out.header.stamp = ToRosTime(object.stamp_nanos);
    out.header.frame_id = reference_frame;
    out.child_frame_id = names.model + "_" + AsSnakeCase(AsRosName(object.name));
    Set(out.transform.translation, object.pose.position);
    Set(out.transform.rotation, object.pose.orientation);
    message.transforms.push_back(out);
  }
}

void FillTransforms(const PersonState& person, const PersonNames& names,
                    const std::string& reference_frame, TfShape shape,
                    tf2_msgs::TFMessage& message) {
  message.transforms.resize(urdf::kSegmentCount + 2 * urdf::kJointCount +
                            person.sample.extra.present.count());
  Writer out(message, reference_frame, StampOf(person.sample));
  if (shape == TfShape::kFlat) {
    WriteFlat(person, names, out);
  } else {
    WriteTree(person, names, out);
  }
  WriteExtra(person, names, shape, out);
}

}  // namespace kinescope::ros_bridge
