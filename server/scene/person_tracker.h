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
#include "server/scene/model_maker.h"
#include "server/scene/recorded_forces.h"

namespace kinescope::app {

class PersonTracker {
 public:
  /// What stays of a person who has left for long, to be continued when the person returns.
  struct Past {
    std::size_t index = 0;       // in the order of appearance
    std::uint64_t revision = 0;  // of the last model
    loads::BandTimes exposure;
  };

  /// `models` and `maker` are borrowed for the lifetime. With a `maker`, a new model is used when
  /// it is ready, except the first; null: it is made at once.
  PersonTracker(const ModelFactory& models, ModelMaker* maker, Character character,
                const Past& past);

  /// Takes over name, colour and scale data; the model changes with them.
  void SetCharacter(const Character& character);

  /// Replaces what was stated before. @pre FindDefect(stated) is ""
  void SetStated(const PersonChange& stated);

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
  Past past() const { return {person_.index, revision_, exposure_}; }

 private:
  void UpdateModel();
  void SetModel(std::shared_ptr<const PersonModel> model);
  bool CheckL5(const BodySample& sample);
  /// Takes the lengths from the poses as long as the source does not send them. True if they are
  /// new.
  bool MeasureSkeleton(const BodySample& sample);
  void WarnOfOtherLengths(const urdf::Skeleton& measured) const;
  static bool LegsHang(const urdf::LinkPoses& links);
  void FindFloor(const BodySample& sample, const urdf::LinkPoses& links,
                 std::optional<double> given);
  void AddLoads(const BodySample& sample, const loads::LoadSettings& settings,
                const loads::Measurements& measured, const loads::BodyMotion* motion,
                PersonState& state);

  const ModelFactory& models_;
  ModelMaker* const maker_;
  PersonDescription person_;
  std::shared_ptr<const PersonModel> model_;  // null before the first sample
  std::uint64_t revision_ = 0;                // of the newest model, made or asked for
  bool has_changed_ = true;                   // person_, since a model was made or asked for
  bool has_new_lengths_ = false;              // that model_ does not have yet
  bool l5_is_checked_ = false;                // against the first pose; see CheckL5
  SkeletonWatch watch_;
  bool is_watched_ = false;  // with lengths that the source sent: watch_ knows those of the poses
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
