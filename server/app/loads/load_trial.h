/// One person's loads over a whole recording: what tables, plots and the report of `kinescope
/// loads` say. States come in one by one; of each only what a plot needs is kept. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/scene_state.h"
#include "server/loads/exposure.h"

namespace kinescope::app {

/// One sample, small: about 300 bytes, so an hour at 60 Hz is 65 MB.
struct TrialSample {
  struct Joint {
    float ratio = 0;                                   // NaN: unknown
    Eigen::Vector3f moment = Eigen::Vector3f::Zero();  // N m, in the parent's link axes; or NaN
    LoadClass load_class = LoadClass::kUnknown;
  };
  std::int64_t stamp_nanos = 0;
  std::array<Joint, urdf::kScoredJointCount> joints;  // in order of kScoredJoints
  float compression = 0;                              // N, at L5/S1; NaN: unknown
};

/// A moment that was hard on a joint, whole, to be drawn.
struct WorstMoment {
  LoadClass load_class = LoadClass::kUnknown;
  double badness = 0;     // ratio, or what L5/S1's compression is on the same scale
  std::size_t joint = 0;  // index into kScoredJoints
  bool by_compression = false;
  std::shared_ptr<const SceneState> scene;
};

/// By class, then by ratio: a class comes a little later than its ratio, and pictures show the
/// class.
bool IsWorse(const WorstMoment& a, const WorstMoment& b);

/// A value's mean and largest over the samples that have it, and when it was largest.
struct Peak {
  double sum = 0, most = 0;
  std::int64_t at_nanos = 0;
  std::uint64_t count = 0;
  void Add(double value, std::int64_t stamp_nanos);
  double mean() const { return sum / static_cast<double>(count); }
};

/// Time, in seconds, by the reason that was given for it.
using SecsByReason = std::map<std::string_view, double>;

class LoadTrial {
 public:
  /// `keeps_curves`: for plots. `begin_nanos`: time 0 of the recording.
  LoadTrial(bool keeps_curves, std::int64_t begin_nanos)
      : keeps_curves_(keeps_curves), begin_nanos_(begin_nanos) {}

  /// The next state that has a new sample of this person.
  void Add(const std::shared_ptr<const SceneState>& scene, const PersonState& person);

  double SecsOf(std::int64_t stamp_nanos) const;  // since begin_nanos

  const PersonState& newest() const;  // @pre Add was called
  std::uint64_t samples() const { return samples_; }
  double secs() const { return exposure_.secs(); }
  bool knows_anything() const;  // of any joint, at any time
  const loads::Exposure& exposure() const { return exposure_; }
  const std::vector<TrialSample>& curves() const { return curves_; }

  /// At most `count`, the worst first, each half a second or more from the others and at least a
  /// twelfth of the trial; none of unknown loads.
  std::vector<WorstMoment> Worst(std::size_t count) const;

  // Why what was not known, and what was not as asked for.
  const SecsByReason& why_unknown(std::size_t joint) const { return why_unknown_[joint]; }
  const SecsByReason& why_static() const { return why_static_; }
  const SecsByReason& why_other_metric() const { return why_other_metric_; }
  const SecsByReason& why_no_ground() const { return why_no_ground_; }

  const Peak& com_difference() const { return com_difference_; }  // |ours - MVN's|, m
  double com_disagrees_secs() const { return com_disagrees_secs_; }
  const Peak& compression() const { return compression_; }  // N, L5/S1
  const Peak& shear() const { return shear_; }              // N, likewise, its size
  /// Above 3400 N and above 6400 N, s (joint-loads.md 4.4).
  const std::array<double, 2>& compression_secs() const { return compression_secs_; }

 private:
  void CountTime(const PersonState& last, double secs);
  void KeepCurve(const PersonState& person);
  void KeepWorst(const std::shared_ptr<const SceneState>& scene, const PersonState& person);
  void MergeSlots();

  bool keeps_curves_;
  std::int64_t begin_nanos_;
  std::uint64_t samples_ = 0;
  std::shared_ptr<const SceneState> scene_;  // of the newest
  const PersonState* newest_ = nullptr;      // in scene_
  loads::Exposure exposure_;
  std::vector<TrialSample> curves_;
  // The worst of each stretch of time; stretches double when there are too many.
  std::map<std::int64_t, WorstMoment> slots_;
  std::int64_t slot_nanos_ = 250'000'000;
  std::array<SecsByReason, urdf::kScoredJointCount> why_unknown_;
  SecsByReason why_static_, why_other_metric_, why_no_ground_;
  Peak com_difference_, compression_, shear_;
  double com_disagrees_secs_ = 0;
  std::array<double, 2> compression_secs_{};
};

}  // namespace kinescope::app
