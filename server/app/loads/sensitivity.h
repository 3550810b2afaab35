/// Shows how much the answer of a trial depends on its assumptions: the same samples are computed
/// again with another body mass, hand load, mass table, load mode and strength, while the recording
/// is read. Costs about as much computing per variation as the trial itself, but no further
/// reading. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_state.h"
#include "server/scene/new_samples.h"
#include "server/scene/scene_builder.h"
#include "server/scene/scene_reader.h"

namespace kinescope::app {

/// One assumption changed, in words, and the options with it.
struct Variation {
  enum class Of { kOther, kMass, kHandLoad, kUnknownHandLoad };

  std::string label;  // "mass 67.5 kg (−10 %)"
  SceneOptions scene;
  Of of = Of::kOther;
  double factor = 1;  // of the mass, or of the hand load
};

/// Body mass −10 % and +10 %; the hand loads lower and higher by 10 %, at least by 1 kg, or 5 kg in
/// both hands if the hand load is unknown; another mass table; with or without accelerations;
/// another percentile of strength. In the order of the report. `may_be_told`: where an option says
/// nothing, the recording may say of each person what the node of the suit was told.
std::vector<Variation> VariationsOf(const SceneOptions& scene, bool may_be_told = false);

/// What one run says about one person.
struct SensitivityRow {
  std::string label;
  std::uint64_t samples = 0;
  /// By class limit and joint: samples above it.
  std::array<std::array<std::uint64_t, urdf::kScoredJointCount>, 2> above{};
  std::array<bool, urdf::kScoredJointCount> is_known{};                // in at least one sample
  float low_back_p90 = std::numeric_limits<float>::quiet_NaN();        // ratio of L5/S1
  double peak_compression = std::numeric_limits<double>::quiet_NaN();  // N
  std::uint64_t compressions = 0, above_action_limit = 0;  // samples: all with a compression, and
                                                           // those above 3400 N
};

/// What was known of a mass over a trial, by an option or by what was told.
class StatedKg {
 public:
  void Add(bool is_known, double kg);

  bool is_known() const { return is_known_; }  // at some time
  bool changes() const { return least_ != most_; }
  double most() const { return most_; }  // kg

 private:
  bool is_known_ = false;
  double least_ = std::numeric_limits<double>::infinity(), most_ = 0;
};

/// Counts the samples of one person.
class LoadTally {
 public:
  void Add(const PersonState& person);
  SensitivityRow Row(std::string label) const;

  const StatedKg& mass() const { return mass_; }
  const StatedKg& hand_load() const { return hand_load_; }

 private:
  SensitivityRow row_;
  StatedKg mass_, hand_load_;
  std::vector<float> low_back_ratios_;
};

class Sensitivity {
 public:
  /// Adds the variations of `scene` to `reader`. Samples later than `length_secs` after the first
  /// one do not count. @pre nothing was read
  Sensitivity(const SceneOptions& scene, std::optional<double> length_secs, SceneReader& reader);
  Sensitivity(const Sensitivity&) = delete;  // the reader refers to it
  Sensitivity& operator=(const Sensitivity&) = delete;

  /// A new sample of the trial itself.
  void AddAsComputed(const PersonState& person) { as_computed_[person.character].Add(person); }

  /// The first row is the trial itself.
  std::vector<SensitivityRow> RowsOf(int character) const;

 private:
  struct Run {
    Variation::Of of = Variation::Of::kOther;
    std::string label;
    double factor = 1;
    std::optional<std::int64_t> begin_nanos;
    NewSamples fresh;
    std::map<int, LoadTally> people;  // by character
  };
  void Add(const SceneState& scene, Run& run) const;
  /// That of `run` for a person; "": it changes nothing of this one.
  std::string LabelOf(const Run& run, const LoadTally& as_computed, const LoadTally& varied) const;

  const bool mass_is_option_, hand_load_is_option_;
  std::optional<double> length_secs_;
  std::vector<Run> runs_;
  std::map<int, LoadTally> as_computed_;  // by character
};

}  // namespace kinescope::app
