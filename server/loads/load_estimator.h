/// Everything about forces that a scene state shows of one person, from samples. One per person; it
/// holds what has a memory (filter, contacts, ramps, classes). A pure function of the samples in
/// order: no clocks, so live view, clips and scrubbing agree. One thread; no allocation.
///
/// What cannot be known is unknown, with its reason, never a low load: numbers that are not finite,
/// legs that were not recorded, flight, a floor that does not explain the posture (sitting,
/// leaning), sensors that stopped.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/body_forces.h"
#include "core/scene_state.h"
#include "server/loads/foot_contact.h"
#include "server/loads/hand_loads.h"
#include "server/loads/inverse_dynamics.h"
#include "server/loads/joint_score.h"
#include "server/loads/load_classifier.h"
#include "server/loads/load_settings.h"
#include "server/loads/motion_filter.h"
#include "server/loads/standing.h"

namespace kinescope::loads {

/// What is known about a person beside the sample. References: borrowed for the call.
struct LoadSubject {
  const urdf::Skeleton& skeleton;
  const urdf::BodyParameters& body;
  bool mass_is_assumed = false;
  bool wears_extra_masses = false;  // MVN does not know of them: its CoM is another body's
  bool has_legs = true;             // false: recorded without leg sensors
  double floor_z = 0;               // world, m
};

struct LoadResult {
  std::array<JointLoad, urdf::kScoredJointCount> loads;  // in order of kScoredJoints
  std::optional<Eigen::Vector3d> cop;  // clamped into the support; absent where it is not known
  BodyForces forces;
};

class LoadEstimator {
 public:
  /// The next sample; `links` are its poses. The reference is good until the next call.
  /// @pre FindDefect(settings) is ""
  const LoadResult& Update(const BodySample& sample, const urdf::LinkPoses& links,
                           const LoadSubject& subject, const LoadSettings& settings,
                           const Measurements& measured = {});

 private:
  void ForgetEverything(const urdf::LinkPoses& links, std::string_view why, std::int64_t stamp);
  void ShowBody(const BodySample& sample, const LoadSubject& subject, const BodyDemand& demand);
  void ShowFloor(const Standing& standing, const LoadSubject& subject, std::int64_t stamp);
  void ShowJoints(const Standing& standing, const urdf::LinkPoses& links);
  std::string_view WhyUnknown(int joint) const;
  /// `rated`: the moment that counts, by joint.
  void ShowLoads(const std::array<Eigen::Vector3d, urdf::kJointCount>& rated,
                 const urdf::LinkPoses& links, const LoadSettings& settings,
                 const Measurements& measured, std::int64_t stamp);
  static void ShowExternal(const ExternalJointLoad& given, const urdf::LinkPoses& links,
                           const LoadSettings& settings, std::int64_t stamp, JointLoad& load);
  void Classify(const LoadSettings& settings, std::int64_t stamp);
  bool SuspectContact(bool outside, std::int64_t stamp);

  MotionFilter motion_;
  FootContacts contacts_;
  HandLoads hands_;
  std::array<LoadClassifier, urdf::kScoredJointCount> classifiers_;
  LoadClassifier compression_;
  std::optional<LoadMetric> last_metric_;
  std::array<bool, urdf::kScoredJointCount> was_external_{};  // by scored joint
  std::array<bool, 2> hand_is_lost_{};                        // its sensor stopped
  // Sitting or leaning: since when the CoP has been on the other side of the limit.
  bool suspects_contact_ = false;
  std::optional<std::int64_t> last_cop_nanos_, contrary_since_nanos_;
  LoadResult result_;
};

}  // namespace kinescope::loads
