/// Exposure statistics of a trial: time in each load class, percentiles and peaks of the load
/// ratio. Memory does not grow with time. One thread; no allocation after construction.
///
/// Reason: a class describes an instant; limits for a working day are about distributions
/// (joint-loads.md 4.5).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "core/scene_state.h"

namespace kinescope::loads {

/// Exposure of one joint. Percentiles are exact to half a bin (kExposureBin / 2) below
/// kExposureMost; kExposureMost means "that or more". The peak is exact.
struct JointExposure {
  std::array<double, 4> secs{};      // by LoadClass
  double p10 = 0, p50 = 0, p90 = 0;  // percentiles of the ratio by time; NaN: always unknown
  double peak_ratio = 0;             // NaN: always unknown
  double peak_moment = 0, peak_capacity = 0;  // N·m, in the governing direction at the peak
  std::string_view peak_channel;
  std::int64_t peak_stamp_nanos = 0;
};

constexpr double kExposureBin = 0.005;
constexpr double kExposureMost = 2.0;

class Exposure {
 public:
  /// Adds the next state of a person's loads, in the order of kScoredJoints. A state counts until
  /// the next one, but at most half a second; a step back in time adds nothing.
  void Add(const std::array<JointLoad, urdf::kScoredJointCount>& loads, std::int64_t stamp_nanos);
  void Add(const std::vector<JointLoad>& loads, std::int64_t stamp_nanos);

  JointExposure Of(std::size_t scored_joint) const;  // index into kScoredJoints
  /// JointExposure::secs only, which is fast.
  std::array<double, 4> SecsOf(std::size_t scored_joint) const;
  double secs() const;  // time counted so far, s

 private:
  static constexpr std::size_t kBins =
      static_cast<std::size_t>(kExposureMost / kExposureBin) + 1;  // the last bin: kExposureMost
                                                                   // and more
  struct Joint;
  void Add(const JointLoad* loads, std::int64_t stamp_nanos);  // all joints
  static double PercentileOf(const Joint& joint, double share);

  struct Joint {
    std::array<std::int64_t, kBins> nanos{};  // time in ns, by ratio
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
