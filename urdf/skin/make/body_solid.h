/// The rest shape of a person of kReferenceHeight as a signed function of the point, in the bind
/// pose, metres: lofts that set the girths, and muscles, bones and features, smoothly joined. Left
/// is modelled; right is its mirror image. Girths are those of ANSUR II (Gordon et al. 2014), by
/// regression on stature and mass. Immutable, any thread.
#pragma once

#include <memory>

#include "urdf/skin/bind_pose.h"
#include "urdf/skin/make/solid.h"
#include "urdf/skin/skin_template.h"

namespace kinescope::skin {

class BodySolid {
 public:
  explicit BodySolid(const Build& build);
  ~BodySolid();

  /// Negative inside, m.
  double operator()(const Point& p) const;
  /// Unit, outwards.
  Point Normal(const Point& p) const;

  /// The parts of the left half alone; `p` is mirrored to it.
  struct Parts {
    double trunk, arm, leg;  // as above; trunk with neck and head
  };
  Parts PartsAt(const Point& p) const;

  const BindPose& bind() const { return bind_; }

 private:
  struct Shape;
  BindPose bind_;
  std::unique_ptr<const Shape> shape_;
};

}  // namespace kinescope::skin
