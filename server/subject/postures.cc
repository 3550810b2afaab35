// Static postures for pictures and tests, in which the body model must look right.
#include "server/subject/motions.h"

namespace kinescope::subject {
namespace {

using Eigen::Vector3d;
using urdf::Side;

// Metres of a person of 1.75 m, degrees.
struct Stance {
  Vector3d pelvis;
  double pelvis_pitch;   // forward
  double spine_flexion;  // shared by its four joints
  double head_pitch;     // of the face, against the thorax
  double feet_apart;     // half of it
  double toe_out;
  double girdle_up;
  double arm_flexion, arm_abduction, elbow_flexion;
};

Stance StanceOf(StaticPosture posture) {
  switch (posture) {
    case StaticPosture::kSquat: return {{-0.225, 0, 0.50}, 30, 22, -34, 0.125, 18, 4, 118, 6, 8};
    case StaticPosture::kOverhead: return {{0, 0, 0.978}, 0, -6, -6, 0.10, 8, 22, 158, 26, 10};
    case StaticPosture::kSit: break;
  }
  return {{-0.40, 0, 0.545}, -6, 12, -2, 0.12, 8, 0, 24, 4, 62};
}

class HeldPosture final : public MotionGenerator {
 public:
  HeldPosture(const urdf::Skeleton& skeleton, StaticPosture posture)
      : skeleton_(skeleton),
        scale_(skeleton.height / urdf::kReferenceHeight),
        stance_(StanceOf(posture)) {}

  double period_secs() const override { return 1; }

  Posture PoseAt(const Jet&) const override {
    Posture posture(skeleton_);
    posture.PlacePelvis(subject::Constant(scale_ * stance_.pelvis),
                        TurnY(stance_.pelvis_pitch * kDegree));
    for (const int segment : {urdf::kL5, urdf::kL3, urdf::kT12, urdf::kT8}) {
      posture.Turn(segment, TurnY(0.25 * stance_.spine_flexion * kDegree));
    }
    for (const int segment : {urdf::kNeck, urdf::kHead}) {
      posture.Turn(segment, TurnY(0.5 * stance_.head_pitch * kDegree));
    }
    for (const Side side : {urdf::kRight, urdf::kLeft}) {
      PlaceLeg(side, posture);
      PlaceArm(side, posture);
    }
    return posture;
  }

 private:
  void PlaceLeg(Side side, Posture& posture) const {
    const double left = side == urdf::kLeft ? 1 : -1;
    const int foot = side == urdf::kRight ? urdf::kRightFoot : urdf::kLeftFoot;
    const double toe_out = left * stance_.toe_out * kDegree;
    const Vector3d ankle(0, scale_ * left * stance_.feet_apart, -skeleton_.heel_in_foot[side].z());
    posture.ReachWithLeg(side, subject::Constant(ankle), toe_out);
    posture.Orient(foot, TurnZ(toe_out));
    posture.Orient(foot + 1, TurnZ(toe_out));
  }

  void PlaceArm(Side side, Posture& posture) const {
    const double left = side == urdf::kLeft ? 1 : -1;
    const int girdle = side == urdf::kRight ? urdf::kRightShoulder : urdf::kLeftShoulder;
    posture.Turn(girdle, TurnX(left * stance_.girdle_up * kDegree));
    posture.Turn(girdle + 1, TurnY(-stance_.arm_flexion * kDegree) *
                                 TurnX(left * stance_.arm_abduction * kDegree));
    posture.Turn(girdle + 2, TurnY(-stance_.elbow_flexion * kDegree));
    posture.Turn(girdle + 3, JetQuaternion::Identity());
  }

  const urdf::Skeleton& skeleton_;
  double scale_;
  Stance stance_;
};

}  // namespace

std::unique_ptr<MotionGenerator> MakeStaticPosture(const urdf::Skeleton& skeleton,
                                                   StaticPosture posture) {
  return std::make_unique<HeldPosture>(skeleton, posture);
}

}  // namespace kinescope::subject
