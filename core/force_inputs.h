/// What is known about forces from outside beside the samples: what the hands hold, what sensors
/// measured, loads that another program computed. Plain data between those who are told
/// (server/ros, server/http, options) and those who compute (server/loads). World frame, metres,
/// newtons, N m. Stamps are of the clock of the samples; what is older than kFreshSecs
/// (server/loads) does not count.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>

#include "core/scene_state.h"
#include "urdf/segments.h"

namespace kinescope {

/// What a person holds. Changes take 0.3 s to become whole, so that a grip is not a blow.
struct HandLoad {
  /// False: nobody said what is held. True with zeros: nothing is, for certain.
  bool is_known = false;
  std::array<double, 2> mass_kg = {0, 0};  // in one hand alone, by urdf::Side
  double both_kg = 0;                      // held with both, shared by them
  /// CoM of what that hand holds alone, in its link frame, m; absent: at the grip point.
  std::array<std::optional<Eigen::Vector3d>, 2> com_in_hand;
  /// Where the CoM of what both hold is, world, m; absent: midway, half the weight each.
  std::optional<Eigen::Vector3d> both_com_in_world;
};

/// A measured force on a hand: of a robot, a handle. World axes, on the human.
struct MeasuredHandForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  // N m, about `point`
  std::optional<Eigen::Vector3d> point;              // world, m; absent: the grip point
  std::int64_t stamp_nanos = 0;
};

/// A ground force by sensors, on the person.
struct MeasuredGroundForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // CoP, m
  double free_moment = 0;                           // N m, about the vertical there
  bool only_vertical = false;  // a plate of one axis: x and y are taken from the motion
  bool only_point = false;     // the CoP alone is measured: the force is taken from the motion
  std::int64_t stamp_nanos = 0;
};

/// One joint as another program has it (joint-loads.md 5.7). What is absent is NaN.
struct ExternalJointLoad {
  Eigen::Vector3d moment = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double ratio = std::numeric_limits<double>::quiet_NaN();  // used as given, before the moment
  LoadClass load_class = LoadClass::kUnknown;               // likewise, before the ratio
  std::int64_t stamp_nanos = 0;                             // 0: never
};

struct Measurements {
  std::array<std::optional<MeasuredHandForce>, 2> hands;    // by urdf::Side
  std::array<std::optional<MeasuredGroundForce>, 2> feet;   // likewise; both or none count
  std::optional<MeasuredGroundForce> ground;                // in total
  std::array<ExternalJointLoad, urdf::kJointCount> joints;  // by urdf::Joint
};

}  // namespace kinescope
