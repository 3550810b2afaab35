#include "server/subject/motions.h"

namespace kinescope::subject {
namespace {

class Stand final : public MotionGenerator {
 public:
  Stand(const urdf::Skeleton& skeleton, Arms arms) : skeleton_(skeleton), arms_(arms) {}

  double period_secs() const override { return 1; }

  Posture PoseAt(const Jet&) const override {
    Posture posture(skeleton_);
    posture.PlacePelvis(subject::Constant(urdf::NPoseOrigins(skeleton_)[urdf::kPelvis]),
                        JetQuaternion::Identity());
    for (int segment = 1; segment < urdf::kSegmentCount; ++segment) {
      // A segment frame is identity in the T-pose, a link frame in the N-pose.
      posture.Orient(segment, arms_ == Arms::kSideways
                                  ? subject::Constant(urdf::SegmentFromLink(segment))
                                  : JetQuaternion::Identity());
    }
    return posture;
  }

 private:
  const urdf::Skeleton& skeleton_;
  Arms arms_;
};

}  // namespace

std::unique_ptr<MotionGenerator> MakeStand(const urdf::Skeleton& skeleton, Arms arms) {
  return std::make_unique<Stand>(skeleton, arms);
}

}  // namespace kinescope::subject
