/// What a trial does to the joints over its whole length: time in each class, percentiles of the
/// ratio, peaks. Memory does not grow with time. One thread; no allocation after construction.
///
/// Why: a class is of a moment; working-day limits are about distributions (joint-loads.md 4.5).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::loads {

/// Of one joint. Percentiles are exact to half a bin (kExposureBin / 2) below kExposureMost, and
/// kExposureMost means "that or more"; the peak is exact.
struct JointExposure {
  std::array<double, 4> secs{};               // by LoadClass
  double p10 = 0, p50 = 0, p90 = 0;           // of the ratio, by time; NaN: never known
  double peak_ratio = 0;                      // NaN: never known
  double peak_moment = 0, peak_capacity = 0;  // N m, of the channel that decided then
  std::string_view peak_channel;
  std::int64_t peak_stamp_nanos = 0;
};

constexpr double kExposureBin = 0.005;
constexpr double kExposureMost = 2.0;

class Exposure {
 public:
  /// The next state of a person's loads, in order of kScoredJoints. Each counts for the time up to
  /// the next, half a second at most; one that steps back in time counts for nothing.
  void Add(const std::array<JointLoad, urdf::kScoredJointCount>& loads, std::int64_t stamp_nanos);
  void Add(const std::vector<JointLoad>& loads, std::int64_t stamp_nanos);

  JointExposure Of(std::size_t scored_joint) const;  // index into kScoredJoints
  /// Only JointExposure::secs, which costs next to nothing.
  std::array<double, 4> SecsOf(std::size_t scored_joint) const;
  double secs() const;  // counted so far

 private:
  static constexpr std::size_t kBins =
      static_cast<std::size_t>(kExposureMost / kExposureBin) + 1;  // the last: that and more
  struct Joint;
  void Add(const JointLoad* loads, std::int64_t stamp_nanos);  // of all joints
  static double PercentileOf(const Joint& joint, double share);

  struct Joint {
    std::array<std::int64_t, kBins> nanos{};  // of time, by ratio
    std::array<std::int64_t, 4> class_nanos{};
    LoadClass last_class = LoadClass::kUnknown;
    double last_ratio = 0;
    JointLoad peak;
    std::int64_t peak_stamp_nanos = 0;
    bool has_peak = false;
  };
  std::array<Joint, urdf::kScoredJointCount> joints_{};
  bool has_last_ = false;
  std::int64_t last_nanos_ = 0;
  std::int64_t counted_nanos_ = 0;
};

}  // namespace kinescope::loads
