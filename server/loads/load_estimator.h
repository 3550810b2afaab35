/// Computes all forces of one person in a scene state from the samples. One object per person; it
/// keeps the parts with memory (filter, contacts, ramps, meters). The result depends only on the
/// samples in order and not on clocks, so live view, clips and scrubbing agree. One thread; no
/// allocation.
///
/// A load that cannot be computed is unknown, with the reason, and never low. Reasons: numbers that
/// are not finite, legs that were not recorded, no foot contact, feet that do not explain the
/// posture (sitting, leaning), sensors that stopped.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/body_forces.h"
#include "core/scene_state.h"
#include "server/loads/foot_contact.h"
#include "server/loads/ground_reaction.h"
#include "server/loads/hand_loads.h"
#include "server/loads/inverse_dynamics.h"
#include "server/loads/joint_score.h"
#include "server/loads/load_meter.h"
#include "server/loads/load_settings.h"
#include "server/loads/motion_filter.h"
#include "server/loads/pose_history.h"

namespace kinescope::loads {

/// Properties of a person beside the sample. References are borrowed for the call.
struct LoadSubject {
  const urdf::Skeleton& skeleton;
  const urdf::BodyParameters& body;
  bool mass_is_assumed = false;
  bool has_added_masses = false;       // MVN does not know the added masses: its CoM is that of
                                       // another body
  bool has_legs = true;                // false: recorded without leg sensors
  double floor_z = 0;                  // world, m
  std::string_view why_no_floor = {};  // why floor_z is only the lowest point of the feet
};

struct LoadResult {
  std::array<JointLoad, urdf::kScoredJointCount> loads;  // in the order of kScoredJoints
  std::optional<Eigen::Vector3d> cop;  // world, m; clamped to the support polygon; absent if
                                       // unknown
  BodyForces forces;
};

class LoadEstimator {
 public:
  /// Processes the next sample; `links` are its poses. `motion`: its derivatives, filtered without
  /// lag (ZeroPhaseFilter); null: they are filtered here, and combined with the poses of as long
  /// ago as the filter delays them. The reference is valid until the next call.
  /// @pre FindDefect(settings) is ""
  const LoadResult& Update(const BodySample& sample, const urdf::LinkPoses& links,
                           const LoadSubject& subject, const LoadSettings& settings,
                           const Measurements& measured = {}, const BodyMotion* motion = nullptr);

 private:
  void ForgetEverything(const urdf::LinkPoses& links, std::string_view why, std::int64_t stamp);
  void ShowBody(const BodySample& sample, const LoadSubject& subject, const BodyDemand& demand);
  void ShowFloor(const GroundReaction& ground, const LoadSubject& subject, std::int64_t stamp);
  void ShowJoints(const GroundReaction& ground, const urdf::LinkPoses& links);
  std::string_view WhyUnknown(int joint) const;
  /// `rated`: the moments to compare with the capacities, by joint, N·m.
  void ShowLoads(const std::array<Eigen::Vector3d, urdf::kJointCount>& rated,
                 const urdf::LinkPoses& links, const LoadSettings& settings,
                 const Measurements& measured, std::int64_t stamp);
  static void ShowExternal(const ExternalJointLoad& given, const urdf::LinkPoses& links,
                           const LoadSettings& settings, std::int64_t stamp, JointLoad& load);
  /// The ratio of L5/S1 is that of the compression force where it is the larger one.
  void CountCompression(const LoadSettings& settings);
  void ReadMeters(const LoadSettings& settings, std::int64_t stamp);
  void CarryHands(const urdf::LinkPoses& from, const urdf::LinkPoses& to);
  bool SuspectContact(bool outside, std::int64_t stamp);

  MotionFilter motion_;
  PoseHistory poses_;
  FootContacts contacts_;
  HandLoads hands_;
  std::array<LoadMeter, urdf::kScoredJointCount> meters_;
  std::optional<LoadMetric> last_metric_;
  std::array<bool, urdf::kScoredJointCount> was_external_{};  // by scored joint
  std::array<bool, 2> hand_is_lost_{};                        // its sensor stopped sending
  // Sitting or leaning, and since when the CoP has been on the other side of the limit.
  bool suspects_contact_ = false;
  std::optional<std::int64_t> last_cop_nanos_, contrary_since_nanos_;
  LoadResult result_;
};

}  // namespace kinescope::loads
