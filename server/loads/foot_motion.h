/// Where heel, ball and toe tip of both feet are, and how fast. Streamed velocities are used where
/// there are any; else those of VelocityFit, which are 0.05 s late. The result depends only on the
/// samples in order. One thread; no allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/body_sample.h"
#include "server/loads/velocity_fit.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

enum FootPoint { kHeelPoint, kBallPoint, kTipPoint, kFootPoints };

class FootMotion {
 public:
  /// Adds a sample; `links` are its poses. A gap of more than 0.5 s or a step back in time starts
  /// over; a repeated stamp changes nothing.
  void Update(const BodySample& sample, const urdf::LinkPoses& links,
              const urdf::Skeleton& skeleton);

  /// World, m.
  const Eigen::Vector3d& at(urdf::Side side, FootPoint point) const {
    return points_[Index(side, point)];
  }
  /// m/s; 0 as long as it is unknown: without streamed velocities, 0.04 s after the start.
  double speed(urdf::Side side, FootPoint point) const { return speeds_[Index(side, point)]; }
  /// The lower one of ball and toe tip.
  FootPoint lower_forefoot(urdf::Side side) const {
    return at(side, kBallPoint).z() < at(side, kTipPoint).z() ? kBallPoint : kTipPoint;
  }

 private:
  static std::size_t Index(urdf::Side side, FootPoint point) {
    return static_cast<std::size_t>(side) * kFootPoints + static_cast<std::size_t>(point);
  }

  VelocityFit fit_;
  VelocityFit::Points points_{};
  std::array<double, VelocityFit::kPoints> speeds_{};
  bool has_last_ = false;
  std::int64_t last_nanos_ = 0;
};

}  // namespace kinescope::loads
