/// Newton–Euler inverse dynamics on measured segment motion: net force and moment at every joint.
/// Uses world axes throughout and needs no joint angles. Any thread, no state, no allocation.
///
/// Source: joint-loads.md 2.1 (motion of a segment's CoM) and 2.2 (recursive form, leaves to root).
/// Static loads are the result of a BodyMotion of zeros.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>

#include "urdf/body_parameters.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

constexpr double kGravity = 9.81;  // m/s^2, as in every reference value; along -z of the world

/// Motion of one segment: of its origin, world axes, without gravity.
struct SegmentMotion {
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();          // m/s^2
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();      // rad/s
  Eigen::Vector3d angular_acceleration = Eigen::Vector3d::Zero();  // rad/s^2
};
using BodyMotion = std::array<SegmentMotion, urdf::kSegmentCount>;  // zeros: static

/// The acceleration of a point fixed to a segment, at `arm` (world axes, m) from its origin.
Eigen::Vector3d AccelerationAt(const SegmentMotion& motion, const Eigen::Vector3d& arm);

/// N and N·m, world axes. The point of reference is stated at each use.
struct Wrench {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

/// Force and moment needed to move and hold up one segment: m (a_com + g) at its CoM, and the rate
/// of change of its angular momentum.
struct SegmentDemand {
  Eigen::Vector3d com = Eigen::Vector3d::Zero();    // world, m
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();   // rate of change of the angular momentum, N·m
};
using BodyDemand = std::array<SegmentDemand, urdf::kSegmentCount>;

/// Accelerations of the CoM of a segment are limited to `most_acceleration` (m/s^2; joint-loads.md
/// 2.3 suggests 30 for suits, because feet and hands oscillate): longer vectors are shortened.
BodyDemand DemandOf(const urdf::LinkPoses& links, const BodyMotion& motion,
                    const urdf::BodyParameters& body,
                    double most_acceleration = std::numeric_limits<double>::infinity());

/// CoM of the body, world, m.
Eigen::Vector3d CenterOfMassOf(const BodyDemand& demand, const urdf::BodyParameters& body);

/// External forces on the body other than gravity: floor, hand loads, tools, handles.
class ExternalForces {
 public:
  /// `force` (N, world axes) acts on `segment` at `point` (world, m), with the pure moment `moment`
  /// (N·m).
  void Push(const urdf::LinkPoses& links, int segment, const Eigen::Vector3d& force,
            const Eigen::Vector3d& point, const Eigen::Vector3d& moment = Eigen::Vector3d::Zero());

  const Wrench& on(int segment) const {
    return on_[urdf::At(segment)];
  }  // about the origin of the
     // segment

 private:
  std::array<Wrench, urdf::kSegmentCount> on_{};
};

/// By segment: force and moment that its parent exerts on it at its origin (N; N·m; world axes).
/// For the pelvis: the residual that nothing explains; zero if the external forces explain the
/// whole motion.
using JointWrenches = std::array<Wrench, urdf::kSegmentCount>;

JointWrenches SolveJoints(const urdf::LinkPoses& links, const BodyDemand& demand,
                          const ExternalForces& external);

/// Wrench that the ground must supply in addition to `external`, about the world's origin
/// (joint-loads.md 2.4).
Wrench RequiredGroundWrench(const urdf::LinkPoses& links, const BodyDemand& demand,
                            const ExternalForces& external);

}  // namespace kinescope::loads
