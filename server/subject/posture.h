/// Builds one pose of the built-in subject with its derivatives, from the pelvis outwards along the
/// chain of a skeleton, so that segments always meet at their joints. Limbs reach their end points
/// by inverse kinematics. World frame, link frames, metres, radians. One thread.
#pragma once

#include <array>

#include "core/body_sample.h"
#include "server/subject/jet.h"
#include "urdf/body_parameters.h"

namespace kinescope::subject {

class Posture {
 public:
  /// Borrows `skeleton`.
  explicit Posture(const urdf::Skeleton& skeleton) : skeleton_(skeleton) {}

  void PlacePelvis(const JetVector& position, const JetQuaternion& world_from_pelvis);

  /// Places `segment` at its joint on its parent. @pre the parent is placed
  void Orient(int segment, const JetQuaternion& world_from_link);
  void Turn(int segment, const JetQuaternion& parent_from_link);

  /// Places thigh and shank so that the ankle is at `ankle`; the knee bends in the vertical plane
  /// of `heading` (about z), turned outwards by `knee_out` about the line from hip to ankle. @pre
  /// the leg reaches it without being fully extended
  void ReachWithLeg(urdf::Side side, const JetVector& ankle, const Jet& heading,
                    const Jet& knee_out = 0.0);

  /// Places upper arm and forearm so that the wrist is at `wrist`, and the hand with the given
  /// orientation. The elbow points back and down, rotated outwards by `swivel`; the forearm takes
  /// all of the hand's rotation about its long axis, as radius and ulna do. @pre the arm reaches it
  /// without being fully extended; arm not stretched sideways
  void ReachWithArm(urdf::Side side, const JetVector& wrist, const JetQuaternion& world_from_hand,
                    const Jet& swivel);

  /// Rotates neck and head so that the face turns `share` of the way to `target`; the eyes do the
  /// rest.
  void LookAt(const JetVector& target, double share);

  const JetVector& position(int segment) const { return links_[Index(segment)].position; }
  const JetQuaternion& orientation(int segment) const { return links_[Index(segment)].orientation; }

  /// World position of a point given in a link frame.
  JetVector PointOn(int segment, const Eigen::Vector3d& in_link) const;

  /// The pose as a sample in segment frames, with all derivatives, the CoM (of `body`) and streamed
  /// joint angles.
  BodySample ToSample(const urdf::BodyParameters& body) const;

 private:
  struct Link {
    JetVector position = JetVector::Zero();
    JetQuaternion orientation = JetQuaternion::Identity();
  };
  static std::size_t Index(int segment) { return static_cast<std::size_t>(segment); }
  JetVector OriginOf(int segment) const;

  const urdf::Skeleton& skeleton_;
  std::array<Link, urdf::kSegmentCount> links_{};
};

}  // namespace kinescope::subject
