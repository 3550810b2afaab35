/// Computes load ratios from joint moments: anatomical directions (joint-loads.md 2.8), capacities
/// (4.2), L5/S1 compression force (4.4). Pure functions; any thread; no allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <limits>
#include <string>
#include <string_view>

#include "core/body_forces.h"
#include "core/compression_limits.h"
#include "core/load_class.h"
#include "urdf/body_parameters.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

enum class Percentile { k5, k50, k95 };

/// The population and person whose capacity a moment is compared with.
struct Strength {
  urdf::Sex sex = urdf::Sex::kMale;
  double factor = 1.0;  // individual capacity factor, 0.1 to 5
  /// Percentile of static strength in the population. Published for flexion, extension and lateral
  /// bending of the trunk, shoulder, elbow, flexion and extension of hip and knee, and plantar
  /// flexion (4.2); other directions are scaled by the mean of those.
  Percentile percentile = Percentile::k50;
};

/// Why `strength` is invalid, with value and limits; "" if it is valid.
[[nodiscard]] std::string FindDefect(const Strength& strength);

struct Score {
  double ratio = 0;     // largest of the joint's anatomical directions
  double moment = 0;    // N·m, signed, in the governing direction
  double capacity = 0;  // N·m, in that direction and sign
  std::string_view channel;
  // The largest of the other directions; NaN and "" without another one.
  double next_ratio = std::numeric_limits<double>::quiet_NaN();
  std::string_view next_channel = {};
};

/// Ratio of `joint` under `moment` (N·m, parent on child, world axes).
Score ScoreJoint(int joint, const Eigen::Vector3d& moment, const urdf::LinkPoses& links,
                 const Strength& strength);

/// |moment| relative to the smaller capacity of the two flexion directions (shoulder: elevation).
Score ScoreNorm(int joint, const Eigen::Vector3d& moment, const urdf::LinkPoses& links,
                const Strength& strength);

/// Compression and shear force at L5/S1 by a single-equivalent-muscle model with a moment arm of
/// `lever_arm_m` (0.05 to 0.06), joint-loads.md 4.4. Force (N) and moment (N·m): pelvis on L5,
/// world axes.
LumbarLoad LumbarLoadOf(const Eigen::Vector3d& force, const Eigen::Vector3d& moment,
                        const urdf::LinkPoses& links, double lever_arm_m = 0.06);

/// Lumbar load on the scale of ratios: the first of the class `limits` at the action limit of
/// 3400 N, the second at the upper limit of 6400 N (NIOSH 1981), linear between and beyond. Shear
/// has one limit, 1000 N at the first, and alone never exceeds the second.
double LumbarRatio(const LumbarLoad& load,
                   const std::array<double, 2>& limits = kDefaultClassLimits);

}  // namespace kinescope::loads
