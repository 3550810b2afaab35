/// Everything about forces that a scene state shows of one person, from samples. One per person; it
/// holds what has a memory (filter, contacts, ramps, classes). A pure function of the samples in
/// order: no clocks, so live view, clips and scrubbing agree. One thread; no allocation after
/// construction.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "server/core/body_forces.h"
#include "server/core/scene_state.h"
#include "server/loads/foot_contact.h"
#include "server/loads/ground.h"
#include "server/loads/hand_loads.h"
#include "server/loads/inverse_dynamics.h"
#include "server/loads/joint_score.h"
#include "server/loads/load_classifier.h"
#include "server/loads/motion_filter.h"

namespace kinescope::loads {

/// "total", "overload", "external", "norm". @throws UsageError naming the value.
LoadMetric ParseLoadMetric(const std::string& text);

struct LoadSettings {
  LoadMetric metric = LoadMetric::kTotal;
  Strength strength;
  HandLoad hands;
  MotionFilter::Settings motion;
  FootContacts::Settings contact;
  LoadClassifier::Settings classes;
  double most_acceleration = 30;   // m/s^2, of a segment's CoM, joint-loads.md 2.3
  bool clamp_cop = true;           // into the feet; off only for worked examples
  bool compression_counts = true;  // L5/S1 shows the worse of moment and compression
};

/// "" or what is wrong, naming option, value and limits.
std::string FindDefect(const LoadSettings& settings);

/// A ground force by sensors, on the person. World frame.
struct MeasuredGroundForce {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  // N
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // CoP, m
  double free_moment = 0;                           // N m, about the vertical there
  bool only_vertical = false;  // a plate of one axis: x and y are taken from the motion
  std::int64_t stamp_nanos = 0;
};

/// One joint as another program has it (joint-loads.md 5.7). What is absent is NaN.
struct ExternalJointLoad {
  Eigen::Vector3d moment = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double ratio = std::numeric_limits<double>::quiet_NaN();  // used as given, before the moment
  LoadClass load_class = LoadClass::kUnknown;               // likewise, before the ratio
  std::int64_t stamp_nanos = 0;                             // 0: never
};

/// What came from outside, by the clock of the samples. Counts for kFreshSecs.
struct Measurements {
  std::array<std::optional<MeasuredHandForce>, 2> hands;    // by urdf::Side
  std::array<std::optional<MeasuredGroundForce>, 2> feet;   // likewise; both or none count
  std::optional<MeasuredGroundForce> ground;                // in total
  std::array<ExternalJointLoad, urdf::kJointCount> joints;  // by urdf::Joint
};

/// What is known about a person beside the sample. References: borrowed for the call.
struct LoadSubject {
  const urdf::Skeleton& skeleton;
  const urdf::BodyParameters& body;
  bool mass_is_assumed = false;
  bool has_legs = true;  // false: recorded without leg sensors
  double floor_z = 0;    // world, m
};

struct LoadResult {
  std::array<JointLoad, 15> loads;     // in order of kScoredJoints
  std::optional<Eigen::Vector3d> cop;  // clamped to the support
  BodyForces forces;
};

class LoadEstimator {
 public:
  /// The next sample; `links` are its poses. The reference is good until the next call.
  const LoadResult& Update(const BodySample& sample, const urdf::LinkPoses& links,
                           const LoadSubject& subject, const LoadSettings& settings,
                           const Measurements& measured);

 private:
  struct Solution;  // of one solve
  Solution Solve() const;

  MotionFilter motion_;
  FootContacts contacts_;
  HandLoads hands_;
  std::array<LoadClassifier, 15> classifiers_;
  LoadClassifier compression_;
  LoadResult result_;
};

}  // namespace kinescope::loads
