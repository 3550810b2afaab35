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

/// The joints that get a sphere, in the order of PersonState::loads: L5/S1, T9/T8, neck (T1/C7),
/// then shoulder, elbow, wrist, hip, knee, ankle, right before left.
extern const std::array<int, 15> kScoredJoints;

struct StaticSolution {
  std::array<Eigen::Vector3d, urdf::kSegmentCount> force{};  // N, parent on segment, world axes
  std::array<Eigen::Vector3d, urdf::kSegmentCount>
      moment{};                                   // N m, at the segment's origin, likewise
  Eigen::Vector3d com = Eigen::Vector3d::Zero();  // of the body, world, m
  // Where the ground pushes, world, m. Absent when no foot is near the floor: then nothing holds
  // the body up, and what is computed for pelvis and legs means nothing.
  std::optional<Eigen::Vector3d> cop;
  double right_foot_share = 0.5;  // of the ground force
};

/// Gravity only. The ground force is the body's weight at the ground projection of its CoM, split
/// between the feet by 2.6; a foot higher than 8 cm above `floor_z` carries nothing, one lower than
/// 4 cm its full share.
StaticSolution SolveStatics(const urdf::LinkPoses& links, const urdf::Skeleton& skeleton,
                            const urdf::BodyParameters& body, double floor_z);

struct Score {
  double ratio = 0;     // max over the joint's channels
  double moment = 0;    // N m, signed, of the deciding channel
  double capacity = 0;  // N m, of that channel and sign
  const char* channel = "";
};

/// Ratio of `joint` under `moment` (N m, parent on child, world axes). Capacities: 4.2, medians.
Score ScoreJoint(int joint, const Eigen::Vector3d& moment, const urdf::LinkPoses& links,
                 urdf::Sex sex);

}  // namespace kinescope::loads
