/// The motions of the built-in subject: each defines the pose of the body over time. Their lengths
/// are those of a person of 1.75 m; for others they are scaled to the stature, at the same pace.
#pragma once

#include <cmath>
#include <memory>

#include "server/subject/pose_text.h"
#include "server/subject/posture.h"
#include "urdf/skeleton.h"

namespace kinescope::subject {

inline constexpr double kDegree = M_PI / 180;

/// Poses one skeleton over time. Borrows the skeleton; any thread, no state.
class MotionGenerator {
 public:
  virtual ~MotionGenerator() = default;
  virtual Posture PoseAt(const Jet& time) const = 0;
  virtual double period_secs() const = 0;  // time after which the motion repeats

 protected:
  MotionGenerator() = default;
};

std::unique_ptr<MotionGenerator> MakeLift(const urdf::Skeleton& skeleton);
std::unique_ptr<MotionGenerator> MakeWalk(const urdf::Skeleton& skeleton);

enum class Arms { kHanging, kSideways };
/// The N-pose or T-pose: every link or segment frame parallel to the world.
std::unique_ptr<MotionGenerator> MakeStand(const urdf::Skeleton& skeleton, Arms arms);

enum class StaticPosture { kSquat, kOverhead, kSit };
/// Deep squat with arms forward; upright with arms raised; seated posture without a chair: the feet
/// carry everything.
std::unique_ptr<MotionGenerator> MakeStaticPosture(const urdf::Skeleton& skeleton,
                                                   StaticPosture posture);

/// `base` with the joints of `pose` bent, standing on z = 0 with the lowest point of its feet.
/// `base` is read at once.
std::unique_ptr<MotionGenerator> MakeWrittenPose(const urdf::Skeleton& skeleton,
                                                 const WrittenPose& pose,
                                                 const MotionGenerator& base);

}  // namespace kinescope::subject
