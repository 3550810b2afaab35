#include <algorithm>
#include <limits>

#include "server/subject/motions.h"
#include "urdf/anatomical_angles.h"

namespace kinescope::subject {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using urdf::At;

Quaterniond LinkOf(const Posture& posture, int segment) {
  const JetQuaternion& q = posture.orientation(segment);
  return {q.w().value, q.x().value, q.y().value, q.z().value};
}

urdf::SegmentOrientations SegmentsOf(const Posture& posture) {
  urdf::SegmentOrientations segments;
  for (int i = 0; i < urdf::kSegmentCount; ++i) {
    segments[At(i)] = LinkOf(posture, i) * urdf::SegmentFromLink(i).conjugate();
  }
  return segments;
}

class WrittenPosture final : public MotionGenerator {
 public:
  WrittenPosture(const urdf::Skeleton& skeleton, const WrittenPose& pose,
                 const MotionGenerator& base)
      : skeleton_(skeleton) {
    const Posture start = base.PoseAt(0);
    const auto angles = urdf::AnatomicalAngles(SegmentsOf(start), urdf::AngleSequence::kZxy);
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      turns_[At(joint)] = TurnOf(joint, start, angles[At(joint)], pose);
    }
    const double heading = pose.values[kHeading].value_or(0) * kDegree;
    const Quaterniond facing(Eigen::AngleAxisd(heading, Vector3d::UnitZ()));
    const JetVector& from = start.position(urdf::kPelvis);
    const Vector3d level(from.x().value, from.y().value, 0);
    const Vector3d place(pose.values[kPlaceX].value_or(0), pose.values[kPlaceY].value_or(0), 0);
    pelvis_.orientation = facing * PelvisOf(start, pose);
    pelvis_.position = place + facing * level;
    pelvis_.position.z() = -LowestOfFeet(PoseAt(0));
  }

  double period_secs() const override { return 1; }

  Posture PoseAt(const Jet&) const override {
    Posture posture(skeleton_);
    posture.PlacePelvis(subject::Constant(pelvis_.position),
                        subject::Constant(pelvis_.orientation));
    for (int joint = 0; joint < urdf::kJointCount; ++joint) {
      posture.Turn(urdf::ChildOf(joint), subject::Constant(turns_[At(joint)]));
    }
    return posture;
  }

 private:
  // parent_from_link. A joint of which nothing is written keeps the rotation of the base, whose
  // angles may not be unique.
  static Quaterniond TurnOf(int joint, const Posture& start, Vector3d angles,
                            const WrittenPose& pose) {
    const int parent = urdf::ParentOf(joint), child = urdf::ChildOf(joint);
    bool is_written = false;
    for (int axis = 0; axis < 3; ++axis) {
      const auto& written = pose.values[AngleOf(joint, axis)];
      is_written = is_written || written;
      angles[axis] = written.value_or(angles[axis]);
    }
    if (!is_written) return LinkOf(start, parent).conjugate() * LinkOf(start, child);
    return urdf::SegmentFromLink(parent).conjugate() * urdf::RotationOfJoint(joint, angles) *
           urdf::SegmentFromLink(child);
  }

  // world_from_pelvis, with heading 0.
  static Quaterniond PelvisOf(const Posture& start, const WrittenPose& pose) {
    Vector3d angles = urdf::AnglesFromRotation(LinkOf(start, urdf::kPelvis));
    if (const auto& bending = pose.values[kPelvisBending]) angles.x() = *bending * kDegree;
    if (const auto& flexion = pose.values[kPelvisFlexion]) angles.y() = *flexion * kDegree;
    return urdf::RotationFromAngles(angles);
  }

  // Of heels, balls and tips of the toes.
  double LowestOfFeet(const Posture& posture) const {
    double lowest = std::numeric_limits<double>::infinity();
    for (const urdf::Side side : {urdf::kRight, urdf::kLeft}) {
      const int foot = urdf::FootSegmentOf(side);
      const Vector3d& heel = skeleton_.heel_in_foot[side];
      Vector3d ball = skeleton_.origin_in_parent[At(foot + 1)];
      ball.z() = heel.z();  // the sole below it
      for (const double z :
           {posture.PointOn(foot, heel).z().value, posture.PointOn(foot, ball).z().value,
            posture.PointOn(foot + 1, skeleton_.toe_tip_in_toe[side]).z().value}) {
        lowest = std::min(lowest, z);
      }
    }
    return lowest;
  }

  const urdf::Skeleton& skeleton_;
  urdf::Pose pelvis_;
  std::array<Quaterniond, urdf::kJointCount> turns_{};  // parent_from_link
};

}  // namespace

std::unique_ptr<MotionGenerator> MakeWrittenPose(const urdf::Skeleton& skeleton,
                                                 const WrittenPose& pose,
                                                 const MotionGenerator& base) {
  return std::make_unique<WrittenPosture>(skeleton, pose, base);
}

}  // namespace kinescope::subject
