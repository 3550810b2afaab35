/// One instant of the built-in subject under construction: link poses with their derivatives, built
/// outwards from the pelvis along the chain of a skeleton, so that joints always meet. Limbs reach
/// their ends by inverse kinematics. World frame, link frames, metres, radians.
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

  /// Places `segment` at its joint on its parent, which must have been placed before.
  void Orient(int segment, const JetQuaternion& world_from_link);
  void Turn(int segment, const JetQuaternion& parent_from_link);

  /// Thigh and shank so that the ankle comes to `ankle`; the knee bends in the vertical plane of
  /// `heading` (about z). @pre the leg reaches it without being stretched out
  void ReachWithLeg(urdf::Side side, const JetVector& ankle, const Jet& heading);

  /// Upper arm and forearm so that the wrist comes to `wrist`, and the hand as given. The elbow
  /// points back and down, turned outwards by `swivel`; the forearm takes over all of the hand's
  /// turn about its long axis, as radius and ulna do. @pre as above; arm not stretched sideways
  void ReachWithArm(urdf::Side side, const JetVector& wrist, const JetQuaternion& world_from_hand,
                    const Jet& swivel);

  /// Neck and head so that the face turns `share` of the way to `target`; eyes do the rest.
  void LookAt(const JetVector& target, double share);

  const JetVector& position(int segment) const { return links_[Index(segment)].position; }
  const JetQuaternion& orientation(int segment) const { return links_[Index(segment)].orientation; }

  /// Where a point of a link's frame is in the world.
  JetVector PointOn(int segment, const Eigen::Vector3d& in_link) const;

  /// As a sample, with all derivatives, CoM (of `body`) and streamed joint angles. Segment frames.
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
