/// Collects one person's loads over a whole recording, for tables, plots and the report of
/// `kinescope loads`. States are added one by one; only the data for plots are kept. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "server/loads/exposure.h"

namespace kinescope::app {

/// One sample in compact form: about 310 bytes, so an hour at 60 Hz takes 67 MB.
struct TrialSample {
  struct Joint {
    float ratio = 0;                                   // NaN: unknown
    Eigen::Vector3f moment = Eigen::Vector3f::Zero();  // N·m, in the parent's link axes; NaN:
                                                       // unknown
    LoadClass band = LoadClass::kUnknown;              // of the ratio
  };
  std::int64_t stamp_nanos = 0;
  std::array<Joint, urdf::kScoredJointCount> joints;  // in the order of kScoredJoints
  float compression = 0;                              // N, at L5/S1; NaN: unknown
  float hands_kg = 0;                                 // load in both hands, ramps included
  std::array<bool, 2> foot_on_floor{};                // by urdf::Side
  bool is_ground_known = false;                       // the ground reaction force
};

/// A point in time with a high joint load, with its full scene state for rendering.
struct WorstMoment {
  double ratio = 0;       // of `joint`
  std::size_t joint = 0;  // index into kScoredJoints
  std::shared_ptr<const SceneState> scene;
  bool is_of_compression = false;  // the highest compression at L5/S1 of the trial
};

/// Mean and maximum of a value over the samples that have it, and the time of the maximum.
struct Peak {
  double sum = 0, most = 0;
  std::int64_t at_nanos = 0;
  std::uint64_t count = 0;
  void Add(double value, std::int64_t stamp_nanos);
  double mean() const { return sum / static_cast<double>(count); }
};

/// Time in seconds, by the reason given for it.
using SecsByReason = std::map<std::string_view, double>;

class LoadTrial {
 public:
  /// `keeps_curves`: required for plots. `begin_nanos`: time 0 of the recording, ns.
  LoadTrial(bool keeps_curves, std::int64_t begin_nanos,
            const loads::LoadMeter::Settings& limits = {})
      : keeps_curves_(keeps_curves), begin_nanos_(begin_nanos), exposure_(limits) {}

  /// Adds the next state with a new sample of this person.
  void Add(const std::shared_ptr<const SceneState>& scene, const PersonState& person);
  /// To be called once, after the last sample, before anything is asked.
  void Finish();

  double SecsOf(std::int64_t stamp_nanos) const;  // s since begin_nanos

  /// What is known of the person beside the motion, from a moment on.
  struct Told {
    std::int64_t stamp_nanos = 0;
    urdf::BodyDescription body;
    HandLoad hands;
  };
  /// At the beginning, and after each change; no more than kMostTold.
  const std::vector<Told>& told() const { return told_; }

  const PersonState& newest() const;  // @pre Add was called
  double floor_z() const;             // of the newest state, world, m. @pre Add was called
  std::uint64_t samples() const { return samples_; }
  double secs() const { return exposure_.secs(); }
  bool knows_anything() const;  // true if any joint load is known at any time
  const loads::Exposure& exposure() const { return exposure_; }
  const std::vector<TrialSample>& curves() const { return curves_; }

  /// At most `count`, apart_secs() apart, the highest load first; none with unknown loads.
  std::vector<WorstMoment> Worst(std::size_t count) const;
  /// At most `count`, apart_secs() apart: the highest compression at L5/S1, if it is known, the
  /// highest ratio, and the highest ratios of other joints (of the moments that are kept).
  std::vector<WorstMoment> WorstPostures(std::size_t count) const;
  /// One second and a twelfth of the trial; in trials below 3 s a third of the trial and 0.5 s.
  double apart_secs() const;

  // Time by reason, for unknown loads and for deviations from the options.
  const SecsByReason& why_unknown(std::size_t joint) const { return why_unknown_[joint]; }
  const SecsByReason& why_static() const { return why_static_; }
  const SecsByReason& why_other_metric() const { return why_other_metric_; }
  const SecsByReason& why_no_ground() const { return why_no_ground_; }

  // Time with measured forces, s: on the feet, and by urdf::Side on a hand.
  double measured_ground_secs() const { return measured_ground_secs_; }
  const std::array<double, 2>& measured_hand_secs() const { return measured_hand_secs_; }

  const Peak& com_minus_mvn() const { return com_minus_mvn_; }  // |com_of_model - MVN's CoM|, m
  double com_disagrees_secs() const { return com_disagrees_secs_; }
  double limited_secs() const { return limited_secs_; }  // BodyForces::acceleration_is_limited
  double causal_secs() const { return causal_secs_; }    // filtered with lag
  double most_delay_secs() const { return most_delay_secs_; }
  const Peak& compression() const { return compression_; }  // N, L5/S1
  const Peak& shear() const { return shear_; }              // N, L5/S1, absolute value
  /// Time above 3400 N and above 6400 N, s (joint-loads.md 4.4).
  const std::array<double, 2>& compression_secs() const { return compression_secs_; }

 private:
  static constexpr std::size_t kMostTold = 100;

  void CountTime(const PersonState& last, double secs);
  void KeepTold(const PersonState& person);
  void KeepCurve(const PersonState& person);
  void KeepWorst(const std::shared_ptr<const SceneState>& scene, const PersonState& person);
  void KeepPeaks(const std::shared_ptr<const SceneState>& scene, const PersonState& person);
  void KeepCompression(const std::shared_ptr<const SceneState>& scene, const PersonState& person);
  void MergeSlots();
  std::optional<WorstMoment> NextPosture(const std::vector<WorstMoment>& before) const;
  bool IsApart(const WorstMoment& moment, const std::vector<WorstMoment>& others) const;

  bool keeps_curves_;
  std::int64_t begin_nanos_;
  std::uint64_t samples_ = 0;
  std::shared_ptr<const SceneState> scene_;  // the newest
  const PersonState* newest_ = nullptr;      // in scene_
  loads::Exposure exposure_;
  std::vector<TrialSample> curves_;
  // The highest load of each time slot; slots double in length when there are too many.
  std::map<std::int64_t, WorstMoment> slots_;
  std::int64_t slot_nanos_ = 250'000'000;
  WorstMoment most_compressed_;
  std::array<WorstMoment, urdf::kScoredJointCount> peaks_;  // of each joint; no scene: unknown
  std::array<SecsByReason, urdf::kScoredJointCount> why_unknown_;
  std::vector<Told> told_;
  SecsByReason why_static_, why_other_metric_, why_no_ground_;
  Peak com_minus_mvn_, compression_, shear_;
  double com_disagrees_secs_ = 0, limited_secs_ = 0, measured_ground_secs_ = 0;
  double causal_secs_ = 0, most_delay_secs_ = 0;
  std::array<double, 2> measured_hand_secs_{};
  std::array<double, 2> compression_secs_{};
};

}  // namespace kinescope::app
