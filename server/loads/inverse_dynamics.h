/// Newton-Euler on measured segment motion: what every joint must carry so that the body moves as
/// it was seen to. Works on world axes throughout, so it needs no joint angles. Any thread, no
/// state, no allocation.
///
/// Source: joint-loads.md 2.1 (motion of a segment's CoM) and 2.2 (recursive form, leaves to root).
/// Static loads are the same with a BodyMotion of zeros.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

#include "urdf/body_parameters.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

constexpr double kGravity = 9.81;  // m/s^2, as in every reference number; along -z of the world

/// How one segment moves. World axes; of the segment's origin; without gravity.
struct SegmentMotion {
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          // m/s^2
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      // rad/s
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  // rad/s^2
};
using BodyMotion = std::array<SegmentMotion, urdf::kSegmentCount>;  // zeros: static

/// The acceleration of a point fixed to a segment, `arm` (world axes, m) away from its origin.
Eigen::Vector3d AccelerationAt(const SegmentMotion& motion, const Eigen::Vector3d& arm);

/// N and N m, world axes. About which point: said where it is used.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// What moving and holding up one segment takes: m (a_com + g) at its CoM, and the rate of change
/// of its spin.
struct SegmentDemand {
  Eigen::Vector3d com = Eigen::Vector3d::Zero();    // world, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();   // N m
};
using BodyDemand = std::array<SegmentDemand, urdf::kSegmentCount>;

/// The acceleration of a segment's CoM is held to `most_acceleration` (m/s^2; joint-loads.md 2.3
/// suggests 30 for suits, whose feet and hands ring): longer vectors are shortened to it.
BodyDemand DemandOf(const urdf::LinkPoses& links, const BodyMotion& motion,
                    const urdf::BodyParameters& body,
                    double most_acceleration = std::numeric_limits<double>::infinity());

/// CoM of the body, world, m.
Eigen::Vector3d CenterOfMassOf(const BodyDemand& demand, const urdf::BodyParameters& body);

/// Forces of the world on the body other than gravity: floor, loads, tools, handles.
class ExternalForces {
 public:
  /// `force` (N) acts on `segment` at `point` (world, m), with the pure moment `moment` (N m).
  void Push(const urdf::LinkPoses& links, int segment, const Eigen::Vector3d& force,
            const Eigen::Vector3d& point, const Eigen::Vector3d& moment = Eigen::Vector3d::Zero());

  const Wrench& on(int segment) const { return on_[urdf::At(segment)]; }  // about its origin

 private:
  std::array<Wrench, urdf::kSegmentCount> on_{};
};

/// By segment: what its parent exerts on it at its origin (N; N m; world axes). Of the pelvis: what
/// nothing supplies, the residual; zero when the external forces account for the whole motion.
using JointWrenches = std::array<Wrench, urdf::kSegmentCount>;

JointWrenches SolveJoints(const urdf::LinkPoses& links, const BodyDemand& demand,
                          const ExternalForces& external);

/// What the ground must supply beside `external`: the total wrench about the world's origin
/// (joint-loads.md 2.4).
Wrench RequiredGroundWrench(const urdf::LinkPoses& links, const BodyDemand& demand,
                            const ExternalForces& external);

}  // namespace kinescope::loads
