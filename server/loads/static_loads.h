/// Static joint moments of arms, spine, neck and legs, their ratio to capacity and their class.
/// Method: joint-loads.md 2.2 (subtree form), 2.4 and 2.6 with a = alpha = omega = 0, 2.8, 4.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "server/core/scene_state.h"
#include "urdf/body_parameters.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

/// The joints that get a sphere, in the order of PersonState::loads: L5/S1, T9/T8, neck (T1/C7), then
/// shoulder, elbow, wrist, hip, knee, ankle, right before left.
extern const std::array<int, 15> kScoredJoints;

struct StaticSolution {
  std::array<Eigen::Vector3d, urdf::kSegmentCount> force{};   // N, parent on segment, world axes
  std::array<Eigen::Vector3d, urdf::kSegmentCount> moment{};  // N m, at the segment's origin, likewise
  Eigen::Vector3d com = Eigen::Vector3d::Zero();              // of the body, world, m
  Eigen::Vector3d cop = Eigen::Vector3d::Zero();              // on the floor, world, m
  double right_foot_share = 0.5;                              // of the ground force
};

/// `floor_z`: height of the ground.
StaticSolution SolveStatics(const urdf::LinkPoses& links, const urdf::Skeleton& skeleton,
                            const urdf::BodyParameters& body, double floor_z);

struct Score {
  double ratio = 0;            // max over the joint's channels
  double moment = 0;           // N m, signed, of the deciding channel
  double capacity = 0;         // N m, of that channel and sign
  const char* channel = "";
};

/// Ratio of `joint` under `moment` (N m, parent on child, world axes). Capacities: 4.2, medians.
Score ScoreJoint(int joint, const Eigen::Vector3d& moment, const urdf::LinkPoses& links,
                 urdf::Sex sex);

/// The class of one joint over time: joint-loads.md 4.3 (low-pass, hysteresis, dwell). Runs on
/// samples, not on drawn frames, so live view, clips and scrubbing agree.
class LoadClassifier {
 public:
  struct Settings {
    double medium_up = 0.30, high_up = 0.60, high_down = 0.55, medium_down = 0.25;
    double low_pass_secs = 0.15, dwell_up_secs = 0.2, dwell_down_secs = 0.5;
  };
  LoadClassifier() = default;
  explicit LoadClassifier(const Settings& settings) : settings_(settings) {}

  /// `ratio` NaN: unknown, and the next valid one starts afresh. Times must not decrease; a step
  /// backwards, or forward by more than 0.5 s, starts afresh too.
  LoadClass Update(double ratio, std::int64_t stamp_nanos);

 private:
  Settings settings_;
  LoadClass class_ = LoadClass::kUnknown;
  double filtered_ = 0;
  std::int64_t last_nanos_ = 0;
  std::array<double, 2> above_secs_{};  // how long above medium_up, high_up
  std::array<double, 2> below_secs_{};  // how long below medium_down, high_down
};

}  // namespace kinescope::loads
