/// The motions that the subject can do: how each poses the body at a time. Lengths in them are
/// those of a person of 1.75 m; others get the same motion in proportion to their stature, equally
/// fast.
#pragma once

#include <cmath>
#include <memory>

#include "server/subject/posture.h"
#include "urdf/skeleton.h"

namespace kinescope::subject {

inline constexpr double kDegree = M_PI / 180;

/// Poses one skeleton over time. Borrows the skeleton; any thread, no state.
class Choreography {
 public:
  virtual ~Choreography() = default;
  virtual Posture PoseAt(const Jet& time) const = 0;
  virtual double period_secs() const = 0;  // when it is back where it began

 protected:
  Choreography() = default;
};

std::unique_ptr<Choreography> MakeLift(const urdf::Skeleton& skeleton);
std::unique_ptr<Choreography> MakeWalk(const urdf::Skeleton& skeleton);

enum class Arms { kHanging, kSideways };
/// The N-pose or T-pose: every link or segment frame parallel to the world.
std::unique_ptr<Choreography> MakeStand(const urdf::Skeleton& skeleton, Arms arms);

enum class Held { kSquat, kOverhead, kSit };
/// Deep in the knees with arms forward; upright with arms raised; as on a chair, which is not
/// there: the feet carry everything.
std::unique_ptr<Choreography> MakeHold(const urdf::Skeleton& skeleton, Held posture);

}  // namespace kinescope::subject
