#include "server/ros/transforms.h"

#include "server/ros/convert.h"
#include "server/ros/stamp.h"

namespace kinescope::ros_bridge {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::Pose;

// Writes transforms one after another into a message whose memory is reused.
class TransformWriter {
 public:
  TransformWriter(tf2_msgs::TFMessage& message, const std::string& reference_frame,
                  const ros::Time& stamp)
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

// Poses after a joint's rotation about y, and after that about x. Both are at the measured origin
// of the child: measured segments are not rigid, and the URDF puts the joint at the child's origin.
std::array<Pose, 2> Between(const PersonState& person, int joint) {
  const Pose& parent = person.links[At(urdf::ParentOf(joint))];
  const Vector3d& origin = person.links[At(urdf::ChildOf(joint))].position;
  const Vector3d& angles = person.angles[At(joint)];
  const Quaterniond after_y = parent.orientation * AngleAxisd(angles.y(), Vector3d::UnitY());
  return {Pose{origin, after_y}, Pose{origin, after_y * AngleAxisd(angles.x(), Vector3d::UnitX())}};
}

void WriteInner(const PersonState& person, const PersonNames& names, TransformWriter& out) {
  for (const int joint : JointsByName()) {
    const auto poses = Between(person, joint);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out.AddToReference(names.between[At(joint)][i], poses[i]);
    }
  }
}

void WriteFlat(const PersonState& person, const PersonNames& names, TransformWriter& out) {
  for (const int segment : SegmentsByName()) {
    out.AddToReference(names.links[At(segment)], person.links[At(segment)]);
  }
  WriteInner(person, names, out);
}

void WriteTree(const PersonState& person, const PersonNames& names, TransformWriter& out) {
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

// A frame to be added below another, for chains that may have either form.
struct Frame {
  const std::string& name;
  const Pose& pose;
};

void Put(TfShape shape, const Frame& parent, const Frame& child, TransformWriter& out) {
  if (shape == TfShape::kFlat) {
    out.AddToReference(child.name, child.pose);
  } else {
    out.Add(parent.name, child.name, Relative(parent.pose, child.pose));
  }
}

void WriteGlove(const PersonState& person, const PersonNames& names, urdf::Side side, TfShape shape,
                TransformWriter& out) {
  const GloveState& glove = *person.gloves[side];
  const std::size_t hand = At(urdf::HandSegmentOf(side));
  for (int finger = 0; finger < kFingersPerHand; ++finger) {
    const int above = kFingerParents[At(finger)];
    const Frame parent = above < 0 ? Frame{names.links[hand], person.links[hand]}
                                   : Frame{names.fingers_and_props[At(FingerIndex(side, above))],
                                           glove.links[At(above)]};
    const std::size_t index = At(FingerIndex(side, finger));
    const Pose& link = glove.links[At(finger)];
    const Vector3d& angles = glove.angles[At(finger)];
    // As in Between.
    const Pose after_y{link.position,
                       parent.pose.orientation * AngleAxisd(angles.y(), Vector3d::UnitY())};
    const Pose after_x{link.position,
                       after_y.orientation * AngleAxisd(angles.x(), Vector3d::UnitX())};
    const Frame y{names.before_fingers_and_props[index][0], after_y};
    const Frame x{names.before_fingers_and_props[index][1], after_x};
    Put(shape, parent, y, out);
    Put(shape, y, x, out);
    Put(shape, x, {names.fingers_and_props[index], link}, out);
  }
}

void WriteProp(const PersonState& person, const PersonNames& names, int prop, TfShape shape,
               TransformWriter& out) {
  const std::size_t index = At(PropIndex(prop));
  const PropState& state = *person.props[At(prop)];
  const Pose& pelvis = person.links[urdf::kPelvis];
  const Vector3d offset = Relative(pelvis, state.pose).position;
  std::array<Pose, 6> chain;  // after each joint: x, y, z; rotations about y, x, z
  for (std::size_t i = 0; i < 3; ++i) {
    Vector3d slid = Vector3d::Zero();
    for (std::size_t axis = 0; axis <= i; ++axis) {
      slid[static_cast<Eigen::Index>(axis)] = offset[static_cast<Eigen::Index>(axis)];
    }
    chain[i] = {pelvis.position + pelvis.orientation * slid, pelvis.orientation};
  }
  chain[3] = {state.pose.position,
              pelvis.orientation * AngleAxisd(state.angles.y(), Vector3d::UnitY())};
  chain[4] = {state.pose.position,
              chain[3].orientation * AngleAxisd(state.angles.x(), Vector3d::UnitX())};
  chain[5] = state.pose;
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const std::vector<std::string>& before = names.before_fingers_and_props[index];
    const Frame parent =
        i == 0 ? Frame{names.links[urdf::kPelvis], pelvis} : Frame{before[i - 1], chain[i - 1]};
    Put(shape, parent, {i < before.size() ? before[i] : names.fingers_and_props[index], chain[i]},
        out);
  }
}

// Number of frames of gloves and props.
std::size_t CountFingersAndProps(const PersonState& person) {
  std::size_t count = 0;
  for (const auto& glove : person.gloves) count += glove ? 3 * kFingersPerHand : 0;
  for (const auto& prop : person.props) count += prop ? 6 : 0;
  return count;
}

void WriteFingersAndProps(const PersonState& person, const PersonNames& names, TfShape shape,
                          TransformWriter& out) {
  for (const urdf::Side side : {urdf::kLeft, urdf::kRight}) {
    if (person.gloves[side]) WriteGlove(person, names, side, shape, out);
  }
  for (int prop = 0; prop < kMaxProps; ++prop) {
    if (person.props[At(prop)]) WriteProp(person, names, prop, shape, out);
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

void FillInnerTransforms(const PersonState& person, const PersonNames& names,
                         const std::string& reference_frame, tf2_msgs::TFMessage& message) {
  message.transforms.resize(2 * urdf::kJointCount);
  TransformWriter out(message, reference_frame, StampOf(person.sample));
  WriteInner(person, names, out);
}

void FillTransforms(const PersonState& person, const PersonNames& names,
                    const std::string& reference_frame, TfShape shape,
                    tf2_msgs::TFMessage& message) {
  if (shape == TfShape::kBase) {
    message.transforms.resize(1);
    TransformWriter(message, reference_frame, StampOf(person.sample))
        .AddToReference(names.links[urdf::kPelvis], person.links[urdf::kPelvis]);
    return;
  }
  message.transforms.resize(urdf::kSegmentCount + 2 * urdf::kJointCount +
                            CountFingersAndProps(person));
  TransformWriter out(message, reference_frame, StampOf(person.sample));
  if (shape == TfShape::kFlat) {
    WriteFlat(person, names, out);
  } else {
    WriteTree(person, names, out);
  }
  WriteFingersAndProps(person, names, shape, out);
}

}  // namespace kinescope::ros_bridge
