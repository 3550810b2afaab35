/// From a joint's moment to a ratio of strength: channels along anatomical axes
/// (joint-loads.md 2.8), capacities (4.2), L5/S1 compression (4.4). Pure functions; any thread; no
/// allocation.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>

#include "core/body_forces.h"
#include "urdf/body_parameters.h"
#include "urdf/kinematics.h"

namespace kinescope::loads {

enum class Percentile { k5, k50, k95 };

/// "5", "50" or "95". @throws UsageError naming the value.
Percentile ParsePercentile(const std::string& text);

/// Whose strength a moment is measured against.
struct Strength {
  urdf::Sex sex = urdf::Sex::kMale;
  double factor = 1.0;  // of this person; 0.1 to 5
  /// Of static strength in the population. Published for trunk flexion, extension and lateral
  /// bending, shoulder, elbow, hip and knee flexion and extension and plantar flexion (4.2); other
  /// directions are scaled by the mean of those.
  Percentile percentile = Percentile::k50;
};

/// "" or what is wrong, naming value and limits.
[[nodiscard]] std::string FindDefect(const Strength& strength);

struct Score {
  double ratio = 0;     // max over the joint's channels
  double moment = 0;    // N m, signed, of the deciding channel
  double capacity = 0;  // N m, of that channel and sign
  std::string_view channel;
};

/// Ratio of `joint` under `moment` (N m, parent on child, world axes).
Score ScoreJoint(int joint, const Eigen::Vector3d& moment, const urdf::LinkPoses& links,
                 const Strength& strength);

/// |moment| against the smaller capacity of the two flexion directions (shoulder: elevation).
Score ScoreNorm(int joint, const Eigen::Vector3d& moment, const urdf::LinkPoses& links,
                const Strength& strength);

/// Force along and across the spine at L5/S1 by one equivalent muscle with a lever arm of
/// `lever_arm_m` (0.05 to 0.06), joint-loads.md 4.4. Force and moment: pelvis on L5, world axes.
LumbarLoad LumbarLoadOf(const Eigen::Vector3d& force, const Eigen::Vector3d& moment,
                        const urdf::LinkPoses& links, double lever_arm_m = 0.06);

/// N: the action limit and the upper limit (NIOSH 1981; joint-loads.md 4.4).
constexpr std::array<double, 2> kCompressionLimits = {3400, 6400};

/// On the scale of ratios: 0.30 at the action limit of 3400 N, 0.60 at the upper limit of 6400 N
/// (NIOSH 1981), straight lines between and beyond. Shear has one limit, 1000 N at 0.30, and alone
/// never goes beyond 0.60.
double LumbarRatio(const LumbarLoad& load);

}  // namespace kinescope::loads
