/// External force data that accompany the samples: hand loads, sensor measurements, external joint
/// loads. Plain data, passed from the receivers (server/ros, server/http, options) to the load
/// computation (server/loads). World frame, metres, newtons, N·m. Stamps are on the clock of the
/// samples; measurements more than kFreshSecs (server/loads/hand_loads.h) away from a sample do not
/// count.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/hand_load.h"
#include "core/scene_state.h"
#include "urdf/segments.h"

namespace kinescope {

/// A measured force on a hand, for example by a robot or a handle. World axes, acting on the human.
struct MeasuredHandForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N·m, about `point`
  std::optional<Eigen::Vector3d> point;              // world, m; absent: the grip point
  std::int64_t stamp_nanos = 0;
};

/// A ground reaction force measured by sensors, acting on the person. World frame.
struct MeasuredGroundForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // CoP, world, m
  double free_moment = 0;                           // N·m, about the vertical through `point`
  bool only_vertical = false;  // plate with one axis: x and y are computed from the motion
  bool only_point = false;     // only the CoP is measured: the force is computed from the motion
  std::int64_t stamp_nanos = 0;
};

/// Load of one joint as another program computed it (joint-loads.md 5.7); moment in N·m. Absent
/// values are NaN.
struct ExternalJointLoad {
  Eigen::Vector3d moment = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double ratio = std::numeric_limits<double>::quiet_NaN();  // used as given; takes precedence over
                                                            // the moment
  LoadClass load_class = LoadClass::kUnknown;  // used as given; takes precedence over the ratio
  std::int64_t stamp_nanos = 0;                // 0: never
};

struct Measurements {
  std::array<std::optional<MeasuredHandForce>, 2> hands;    // by urdf::Side
  std::array<std::optional<MeasuredGroundForce>, 2> feet;   // by urdf::Side; used only if both are
                                                            // present
  std::optional<MeasuredGroundForce> ground;                // total of both feet
  std::array<ExternalJointLoad, urdf::kJointCount> joints;  // by urdf::Joint
};

}  // namespace kinescope
