/// Follows one person of a stream from sample to sample: model, angles, gloves and props, loads and
/// exposure. The result depends only on the samples in order. One thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "core/scene_state.h"
#include "core/skeleton_watch.h"
#include "server/loads/exposure.h"
#include "server/loads/floor_finder.h"
#include "server/loads/foot_motion.h"
#include "server/loads/load_estimator.h"
#include "server/scene/model_factory.h"
#include "server/scene/recorded_forces.h"

namespace kinescope::app {

class PersonTracker {
 public:
  /// `index`: in the order of appearance. `models` is borrowed for the lifetime.
  PersonTracker(const ModelFactory& models, Character character, std::size_t index);

  /// Takes over name, colour and scale data; the model changes with them.
  void SetCharacter(const Character& character);

  /// What is known beside the sample.
  struct Known {
    std::optional<double> floor_z;              // of the floor, world, m; absent: it is found
    const loads::BodyMotion* motion = nullptr;  // filtered without lag
    RecordedForces* forces = nullptr;           // of a file; null: those that were set
  };

  /// Computes the state of the next sample.
  /// @pre the sample is of this person; FindDefect(settings) is ""
  void Update(const BodySample& sample, const loads::LoadSettings& settings,
              const loads::Measurements& measured, const Known& known);

  /// That of the newest sample; null before the first.
  const PersonState* state() const { return state_ ? &*state_ : nullptr; }
  /// Height of the ground under this person, world, m; absent before the first sample.
  std::optional<double> floor_z() const { return floor_z_; }

 private:
  void Remodel();
  bool CheckL5(const BodySample& sample);
  /// Takes the lengths from the poses as long as the source does not send them. True if they are
  /// new.
  bool MeasureSkeleton(const BodySample& sample);
  static bool LegsHang(const urdf::LinkPoses& links);
  void FindFloor(const BodySample& sample, const urdf::LinkPoses& links,
                 std::optional<double> given);
  void AddLoads(const BodySample& sample, const loads::LoadSettings& settings,
                const loads::Measurements& measured, const loads::BodyMotion* motion,
                PersonState& state);

  const ModelFactory& models_;
  PersonDescription person_;
  std::shared_ptr<const PersonModel> model_;  // never null
  bool l5_is_checked_ = false;                // against the first pose; see CheckL5
  SkeletonWatch watch_;
  urdf::JointAngles angles_{};
  urdf::RigidDeviation worst_deviation_;
  loads::LoadEstimator loads_;
  loads::BandTimes exposure_;
  bool has_legs_ = false;  // from the first sample on in which a leg is bent
  loads::FootMotion feet_;
  loads::FloorFinder floor_;
  std::optional<double> floor_z_;  // m; set with the first sample
  std::string_view why_no_floor_;
  std::optional<PersonState> state_;
};

}  // namespace kinescope::app
